// promise: Nor does a build step learn how many page faults its children had.
// expect: exited 0
// policy: tools
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    struct rusage usage;
    refused(getrusage(RUSAGE_CHILDREN, &usage), "getrusage");
    pid_t child = fork();
    if (child == 0) _exit(0);
    siginfo_t about;
    refused(syscall(SYS_waitid, P_PID, child, &about, WEXITED, &usage), "waitid");
    refused(syscall(SYS_wait4, child, NULL, 0, &usage), "wait4");
    if (waitpid(child, NULL, 0) != child) breach("a child is lost");
}
