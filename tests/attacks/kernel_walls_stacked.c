// promise: A program cannot install its own filters, which could observe system calls or answer them.
// expect: exited 0
#include "attack.h"
#ifndef PR_SET_SYSCALL_USER_DISPATCH
#define PR_SET_SYSCALL_USER_DISPATCH 59
#endif
int main(int argc, char **argv) {
    begin(argc);
    struct { unsigned short length; void *filter; } none = {0};
    refused(syscall(SYS_seccomp, 1, 8, &none), "a filter with a listener");
    refused(syscall(SYS_seccomp, 1, 1, &none), "a filter for all threads");
    refused(prctl(PR_SET_SECCOMP, 2, &none, 0, 0), "a filter by prctl");
    refused(prctl(PR_SET_SECCOMP, 1, 0, 0, 0), "the strict mode");
    refused(syscall(444, &none, sizeof none, 0), "a ruleset");
    refused(syscall(446, 0, 0), "a ruleset in force");
    refused(prctl(PR_SET_SYSCALL_USER_DISPATCH, 1, 0, 0, 0), "a dispatcher of calls");
}
