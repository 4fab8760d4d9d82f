// promise: Pages of a library that a program has written to count toward the memory limit.
// expect: memory
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    void *handle = fopen("/proc/self/maps", "r");
    int fd = open(argv[0], O_RDONLY);
    if (!handle || fd < 0) return 1;
    for (int i = 0; i < 100000; i++) {
        char *part = mmap(NULL, 16 << 10, PROT_READ | PROT_WRITE, MAP_PRIVATE, fd, 0);
        if (part == MAP_FAILED) break;
        memset(part, 1, 16 << 10);
    }
    for (;;) pause();
}
