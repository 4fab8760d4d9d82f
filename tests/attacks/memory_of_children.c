// promise: The total memory of all processes is limited.
// expect: memory
// policy: tools
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    for (int i = 0; i < 6; i++) {
        if (fork() == 0) {
            memset(malloc(24 << 20), 1, 24 << 20);
            for (;;) pause();
        }
    }
    for (;;) pause();
}
