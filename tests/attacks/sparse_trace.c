// promise: A trace that is longer than its limit is not collected, even if it takes no space.
// expect: output or exited 0
// leaves: refused
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    int fd = open("trace.bin", O_WRONLY | O_CREAT, 0644);
    return ftruncate(fd, 3 << 20);
}
