// promise: A program cannot use the x32 numbers of system calls.
// expect: exited 0
// needs: x86_64
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    refused(syscall(0x40000000 | SYS_getpid), "x32 getpid");
    refused(syscall(0x40000000 | 521), "x32 ptrace");
    refused(syscall(0x40000000 | 520), "x32 execve");
}
