// promise: The counters of faults, of waiting and of resident pages in /proc are closed.
// expect: exited 0
// needs: file rules
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    for (const char **name = (const char *[]){"stat", "statm", "status", "io", "sched", "schedstat", "oom_score", "wchan", "syscall", "smaps", NULL}; *name; name++) {
        unreadable(in("/proc/self", *name));
        unreadable(in("/proc/thread-self", *name));
    }
}
