// promise: A program cannot change the priority of other processes.
// expect: exited 0
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    int victim = atoi(argv[2]);
    struct sched_param parameters = {0};
    refused(setpriority(PRIO_PROCESS, victim, 19), "setpriority");
    refused(setpriority(PRIO_USER, getuid(), 19), "setpriority of all");
    refused(sched_setscheduler(victim, SCHED_IDLE, &parameters), "sched_setscheduler");
    refused(syscall(SYS_ioprio_set, 1, victim, 3 << 13), "ioprio_set");
}
