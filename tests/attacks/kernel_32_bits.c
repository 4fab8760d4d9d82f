// promise: A program cannot use the system calls of 32-bit programs.
// expect: violation
// needs: x86_64
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    long answer = 20;
    __asm__ volatile("int $0x80" : "+a"(answer) : : "memory", "r8", "r9", "r10", "r11");
    breach("int 0x80");
}
