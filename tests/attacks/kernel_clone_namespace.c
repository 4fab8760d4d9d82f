// promise: A program cannot create namespaces by starting a process.
// expect: violation clone
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    forbidden(syscall(SYS_clone, CLONE_NEWUSER | SIGCHLD, 0, 0, 0, 0), "clone");
}
