// promise: A program cannot read sockets, mounts and groups of the host in /proc.
// expect: exited 0
// needs: file rules
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    const char *names[] = {"net/tcp", "net/unix", "net/dev", "net/route", "mountinfo", "mounts", "mountstats", "cgroup", "cpuset",
                           "sched", "schedstat", "io", "syscall", "stack", "wchan"};
    for (int i = 0; i < sizeof names / sizeof *names; i++) {
        char path[200];
        snprintf(path, sizeof path, "/proc/self/%s", names[i]);
        unreadable(path);
        snprintf(path, sizeof path, "/proc/self/task/%d/%s", getpid(), names[i]);
        unreadable(path);
        snprintf(path, sizeof path, "/proc/thread-self/%s", names[i]);
        unreadable(path);
    }
    unreadable("/proc/net/tcp");
    unreadable("/proc/mounts");
}
