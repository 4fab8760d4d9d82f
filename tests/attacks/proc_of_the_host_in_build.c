// promise: A build step cannot read sockets, mounts and groups of the host in /proc.
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
