// promise: A program cannot let its parent trace it.
// expect: violation ptrace
#include "attack.h"
#include <sys/ptrace.h>
int main(int argc, char **argv) {
    begin(argc);
    forbidden(ptrace(PTRACE_TRACEME, 0, 0, 0), "ptrace");
}
