// promise: A trace that is a terabyte of holes is rejected.
// expect: folder
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    int fd = open("trace.bin", O_WRONLY | O_CREAT, 0644);
    if (ftruncate(fd, 1L << 40) == 0) breach("a terabyte");
}
