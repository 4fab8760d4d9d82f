// promise: A program cannot read or change data that the kernel shares between all programs.
// expect: exited 0
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    int fd = open(argv[0], O_RDONLY);
    char *page = mmap(NULL, 4096, PROT_READ, MAP_SHARED, fd, 0);
    unsigned long words[64] = {0};
    int mode = 0;
    refused(syscall(SYS_readahead, fd, 0, 4096), "readahead");
    refused(syscall(SYS_sync_file_range, fd, 0, 4096, 1), "sync_file_range");
    refused(syscall(SYS_syncfs, fd), "syncfs");
    refused(syscall(SYS_mlock2, page, 4096, 1), "mlock2");
    refused(syscall(SYS_get_mempolicy, &mode, words, 64, page, 3), "get_mempolicy");
    refused(syscall(SYS_mbind, page, 4096, 0, NULL, 0, 0), "mbind");
    refused(syscall(SYS_io_setup, 8, words), "io_setup");
    refused(syscall(SYS_inotify_init1, 0), "inotify_init1");
    refused(syscall(SYS_memfd_create, "x", 0), "memfd_create");
    refused(syscall(SYS_splice, fd, NULL, 1, NULL, 4096, 2), "splice");
    refused(syscall(SYS_tee, 0, 1, 4096, 2), "tee");
    refused(syscall(SYS_pidfd_open, getppid(), 0), "pidfd_open");
    refused(syscall(448, 3, 0), "process_mrelease");
    refused(syscall(457, words, words, sizeof words, 0), "statmount");
    refused(syscall(458, words, words, 8, 0), "listmount");
    refused(syscall(468, fd, "", words, sizeof words, 0x1000), "file_getattr");
    refused(syscall(461, words, words, 0), "lsm_list_modules");
    refused(syscall(SYS_ustat, 1, words), "ustat");
    refused(syscall(SYS_sysfs, 3), "sysfs");
    // The size of a pipe says how many others there are.
    int ends[2];
    if (!pipe(ends)) refused(fcntl(ends[0], F_GETPIPE_SZ), "the size of a pipe");
}
