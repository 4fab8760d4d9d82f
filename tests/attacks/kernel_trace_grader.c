// promise: A program cannot trace the grader.
// expect: violation ptrace
#include "attack.h"
#include <sys/ptrace.h>
int main(int argc, char **argv) {
    begin(argc);
    forbidden(ptrace(PTRACE_ATTACH, atoi(argv[2]), 0, 0), "ptrace");
}
