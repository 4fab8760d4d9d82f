// promise: A program cannot continue after a forbidden call by catching its signal.
// expect: violation ptrace
#include "attack.h"
#include <sys/ptrace.h>
int main(int argc, char **argv) {
    begin(argc);
    signal(SIGSYS, SIG_IGN);
    ptrace(PTRACE_TRACEME, 0, 0, 0);
    breach("ptrace");
}
