// promise: A program cannot watch or lock other users' files.
// expect: exited 0
#include "attack.h"
#include <sys/inotify.h>
int main(int argc, char **argv) {
    begin(argc);
    refused(inotify_init1(0), "inotify");
    refused(syscall(SYS_pidfd_open, getppid(), 0), "pidfd_open");
    refused(syscall(SYS_pidfd_open, atoi(argv[2]), 0), "pidfd_open");
}
