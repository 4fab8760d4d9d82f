// promise: Holes do not pass a trace pipe: only bytes that were written arrive.
// expect: exited 0
// pipe: 4
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    int fd = open("trace.bin", O_WRONLY);
    refused(lseek(fd, 1 << 30, SEEK_SET), "lseek in a pipe");
    refused(ftruncate(fd, 1 << 30), "ftruncate of a pipe");
    refused(pwrite(fd, "far", 3, 1 << 30), "pwrite in a pipe");
    write(fd, "near", 4);
}
