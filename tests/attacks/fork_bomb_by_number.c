// promise: A submission cannot start other processes by the number of the system call.
// expect: violation
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    syscall(SYS_clone, SIGCHLD, 0, 0, 0, 0);
    breach("clone");
}
