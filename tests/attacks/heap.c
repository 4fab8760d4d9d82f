// promise: A program cannot hold more memory than its limit.
// expect: memory
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    for (;;) {
        char *block = malloc(1 << 20);
        if (block) memset(block, 1, 1 << 20);
    }
}
