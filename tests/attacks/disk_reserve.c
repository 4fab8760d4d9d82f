// promise: Disk space cannot be reserved without writing.
// expect: exited 0
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    int fd = open("reserved", O_WRONLY | O_CREAT, 0644);
    refused(fallocate(fd, 0, 0, 1 << 20), "fallocate");
}
