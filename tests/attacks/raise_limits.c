// promise: A program cannot raise its limits, or change those of other processes.
// expect: exited 0
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    int kinds[] = {RLIMIT_CPU, RLIMIT_FSIZE, RLIMIT_NOFILE, RLIMIT_AS};
    for (int i = 0; i < 4; i++) {
        struct rlimit limit;
        getrlimit(kinds[i], &limit);
        if (limit.rlim_max == RLIM_INFINITY) breach("no limit");
        limit.rlim_cur = limit.rlim_max = RLIM_INFINITY;
        refused(setrlimit(kinds[i], &limit), "setrlimit");
    }
    struct rlimit tight = {1, 1};
    refused(prlimit(getppid(), RLIMIT_NOFILE, &tight, NULL), "prlimit of the parent");
    refused(prlimit(atoi(argv[2]), RLIMIT_NOFILE, &tight, NULL), "prlimit of the grader");
    refused(setpriority(PRIO_PROCESS, 0, -20), "setpriority");
    struct sched_param first = {1};
    refused(sched_setscheduler(0, SCHED_FIFO, &first), "sched_setscheduler");
}
