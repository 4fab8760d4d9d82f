// promise: A program cannot start a process by the newer call (clone3).
// expect: exited 0
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    uint64_t arguments[11] = {CLONE_NEWUSER, 0, 0, 0, SIGCHLD};
    refused(syscall(SYS_clone3, arguments, sizeof arguments), "clone3");
    if (errno != ENOSYS) breach("clone3 exists");
}
