// promise: No call tells a program how many page faults it had, which would say what was in memory before it came.
// expect: exited 0
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    struct rusage usage;
    for (int who = -1; who <= 1; who++) refused(getrusage(who, &usage), "getrusage");
    errno = 0;
    refused(syscall(SYS_wait4, -1, NULL, WNOHANG, &usage), "wait4");
    if (errno == ECHILD) breach("wait4 with counters");
    siginfo_t about;
    refused(syscall(SYS_waitid, P_ALL, 0, &about, WEXITED | WNOHANG, &usage), "waitid");
    if (errno == ECHILD) breach("waitid with counters");
}
