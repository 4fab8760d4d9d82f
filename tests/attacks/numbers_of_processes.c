// promise: A program cannot find out which processes exist.
// expect: exited 0
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    int victim = atoi(argv[2]);
    refused(getsid(victim), "getsid");
    refused(getpgid(victim), "getpgid");
    refused(sched_getscheduler(victim), "sched_getscheduler");
    struct sched_param parameters;
    refused(sched_getparam(victim, &parameters), "sched_getparam");
    cpu_set_t set;
    refused(sched_getaffinity(victim, sizeof set, &set), "sched_getaffinity");
    errno = 0;
    getpriority(PRIO_PROCESS, victim);
    if (!errno) breach("getpriority");
    struct rlimit limit;
    refused(prlimit(victim, RLIMIT_NOFILE, NULL, &limit), "prlimit");
    refused(kill(victim, 0), "kill 0");
}
