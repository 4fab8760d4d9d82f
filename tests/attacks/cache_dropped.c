// promise: Nor drop or load the pages of a file at will.
// expect: exited 0
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    int fd = open("/proc/self/exe", O_RDONLY);
    errno = posix_fadvise(fd, 0, 0, POSIX_FADV_DONTNEED);
    if (!errno) breach("posix_fadvise");
    refused(syscall(SYS_readahead, fd, 0, 4096), "readahead");
    refused(syscall(SYS_sync_file_range, fd, 0, 4096, 7), "sync_file_range");
}
