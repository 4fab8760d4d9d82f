// promise: Swapped memory counts toward the limit, and a program cannot swap memory itself.
// expect: memory
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    for (size_t i = 0; i < 300; i++) {
        char *part = mmap(NULL, 1 << 20, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
        if (part == MAP_FAILED) break;
        memset(part, 1, 1 << 20);
        if (!madvise(part, 1 << 20, 21)) breach("a page went to the disk");
        usleep(1000);
    }
    sleep(1);
    breach("300 MiB");
}
