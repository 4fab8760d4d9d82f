// promise: A program cannot execute a file, wherever in memory the path is.
// expect: violation execve
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    for (uintptr_t at = 0x10000; at < 0x7ff000000000; at += at < 0x100000000 ? 0x1000000 : 0x1000000000) {
        char *page = mmap((void *)at, 4096, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_FIXED_NOREPLACE, -1, 0);
        if (page == MAP_FAILED) continue;
        strcpy(page, "/bin/sh");
        char *words[] = {"sh", NULL};
        execv(page, words);
    }
    breach("execve");
}
