// promise: Nor can a build step read them.
// expect: exited 0
// policy: tools
// needs: file rules
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    unreadable("/proc/self/net/tcp");
    unreadable("/proc/self/mountinfo");
    unreadable("/proc/self/cgroup");
    unreadable("/proc/sched_debug");
}
