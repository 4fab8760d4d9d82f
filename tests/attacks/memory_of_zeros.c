// promise: Memory behind /dev/zero counts toward the limit.
// expect: exited 0 or memory
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    int fd = open("/dev/zero", O_RDWR);
    if (fd < 0) return 0;
    for (int i = 0; i < 8; i++) {
        char *part = mmap(NULL, 50 << 20, PROT_READ | PROT_WRITE, MAP_SHARED, fd, 0);
        if (part == MAP_FAILED) return 0;
        memset(part, 1, 50 << 20);
        madvise(part, 50 << 20, MADV_DONTNEED);
    }
    for (;;) pause();
}
