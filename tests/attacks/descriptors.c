// promise: The number of open files is limited.
// expect: exited 0
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    int highest = 0, fd;
    while ((fd = dup(1)) >= 0) highest = fd;
    if (highest >= 32) breach("more descriptors than allowed");
}
