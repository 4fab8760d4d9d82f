// promise: Memory that grows in place counts toward the limit.
// expect: memory
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    size_t size = 1 << 20;
    char *part = mmap(NULL, size, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    for (; part != MAP_FAILED; size += 1 << 20) {
        memset(part + size - (1 << 20), 1, 1 << 20);
        part = mremap(part, size, size + (1 << 20), MREMAP_MAYMOVE);
    }
    for (;;) pause();
}
