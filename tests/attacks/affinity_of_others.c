// promise: A program cannot decide on which processors others run.
// expect: exited 0
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    cpu_set_t one;
    CPU_ZERO(&one);
    CPU_SET(0, &one);
    refused(sched_setaffinity(atoi(argv[2]), sizeof one, &one), "sched_setaffinity");
    refused(sched_setaffinity(getppid(), sizeof one, &one), "sched_setaffinity of the supervisor");
    if (sched_setaffinity(0, sizeof one, &one)) return 1;
}
