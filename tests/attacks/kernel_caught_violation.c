// promise: A program cannot catch the end that a forbidden call brings.
// expect: violation ptrace
#include "attack.h"
#include <sys/ptrace.h>
int main(int argc, char **argv) {
    begin(argc);
    signal(SIGSYS, SIG_IGN);
    ptrace(PTRACE_TRACEME, 0, 0, 0);
    breach("ptrace");
}
