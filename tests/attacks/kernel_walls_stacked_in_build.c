// promise: A build step cannot install its own filters.
// expect: exited 0
// policy: tools
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    struct { unsigned short length; void *filter; } none = {0};
    refused(syscall(SYS_seccomp, 1, 8, &none), "a filter with a listener");
    refused(prctl(PR_SET_SECCOMP, 2, &none, 0, 0), "a filter by prctl");
    refused(syscall(444, &none, sizeof none, 0), "a ruleset");
    if (fork() == 0) {
        refused(syscall(SYS_seccomp, 1, 8, &none), "a filter in a child");
        _exit(0);
    }
    int status;
    wait(&status);
    return WEXITSTATUS(status);
}
