// promise: A program cannot make itself unreadable to its supervisor or traceable by others, or change its apparent identity.
// expect: exited 0
#include "attack.h"
#ifndef PR_SET_IO_FLUSHER
#define PR_SET_IO_FLUSHER 57
#endif
#ifndef PR_SCHED_CORE
#define PR_SCHED_CORE 62
#endif
int main(int argc, char **argv) {
    begin(argc);
    refused(prctl(PR_SET_DUMPABLE, 0, 0, 0, 0), "PR_SET_DUMPABLE");
    refused(prctl(PR_SET_PTRACER, -1L, 0, 0, 0), "PR_SET_PTRACER");
    refused(prctl(PR_SET_MM, 1, 0, 0, 0), "PR_SET_MM");
    refused(prctl(PR_SET_KEEPCAPS, 1, 0, 0, 0), "PR_SET_KEEPCAPS");
    refused(prctl(PR_SET_TSC, 2, 0, 0, 0), "PR_SET_TSC");
    refused(prctl(PR_SET_THP_DISABLE, 1, 0, 0, 0), "PR_SET_THP_DISABLE");
    refused(prctl(PR_SET_IO_FLUSHER, 1, 0, 0, 0), "PR_SET_IO_FLUSHER");
    refused(prctl(PR_SCHED_CORE, 1, 0, 0, 0), "PR_SCHED_CORE");
}
