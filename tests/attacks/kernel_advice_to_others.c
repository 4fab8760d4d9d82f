// promise: A program cannot advise the kernel on the memory of other processes, or compare its descriptors with theirs.
// expect: violation kcmp
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    struct iovec part = {main, 4096};
    refused(syscall(440, 0, &part, 1L, MADV_DONTNEED, 0), "process_madvise");
    refused(syscall(448, 0, 0), "process_mrelease");
    refused(syscall(SYS_pidfd_open, getpid(), 0), "pidfd_open of itself");
    forbidden(syscall(SYS_kcmp, getpid(), getppid(), 0, 0, 0), "kcmp");
}
