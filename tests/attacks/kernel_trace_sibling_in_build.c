// promise: A build step cannot trace its own processes.
// expect: violation ptrace
// policy: tools
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    pid_t child = fork();
    if (child == 0) {
        for (;;) pause();
    }
    forbidden(syscall(SYS_ptrace, 16, child, 0, 0), "ptrace of a child");
}
