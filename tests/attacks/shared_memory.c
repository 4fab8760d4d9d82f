// promise: Shared memory counts as memory.
// expect: memory
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    for (;;) {
        char *block = mmap(NULL, 1 << 20, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
        if (block != MAP_FAILED) memset(block, 1, 1 << 20);
    }
}
