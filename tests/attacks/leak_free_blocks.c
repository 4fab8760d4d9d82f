// promise: A program cannot read how full the disks are.
// expect: exited 0
#include "attack.h"
#include <sys/vfs.h>
int main(int argc, char **argv) {
    begin(argc);
    struct statfs about;
    for (const char **path = (const char *[]){".", "/", "/proc/self/exe", "/tmp", NULL}; *path; path++) {
        refused(statfs(*path, &about), "statfs");
        int fd = open(*path, O_RDONLY);
        if (fd >= 0) refused(fstatfs(fd, &about), "fstatfs");
    }
    long long version;
    int fd = open(argv[0], O_RDONLY);
    refused(ioctl(fd, 0x80087601, &version), "the generation of an inode");
    refused(ioctl(fd, 0xC020660B, block), "where a file lies");
}
