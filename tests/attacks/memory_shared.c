// promise: A program cannot use shared memory without a file, which no counter shows.
// expect: exited 0
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    for (int i = 0; i < 8; i++) {
        char *part = mmap(NULL, 50 << 20, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
        if (part == MAP_FAILED) return 0;
        memset(part, 1, 50 << 20);
        madvise(part, 50 << 20, MADV_DONTNEED);
    }
    breach("shared memory");
}
