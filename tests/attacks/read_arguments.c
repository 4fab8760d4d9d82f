// promise: A program cannot read the command lines of other processes.
// expect: exited 0
// needs: file rules
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    char path[100];
    snprintf(path, sizeof path, "/proc/%d/cmdline", getppid());
    unreadable(path);
    snprintf(path, sizeof path, "/proc/%s/cmdline", argv[2]);
    unreadable(path);
    if (opendir("/proc")) breach("processes can be listed");
}
