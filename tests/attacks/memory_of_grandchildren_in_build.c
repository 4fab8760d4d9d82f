// promise: The memory of processes whose parents have ended counts toward the limit of a build step.
// expect: memory
// policy: tools
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    for (int i = 0; i < 6; i++) {
        if (fork() == 0) {
            if (fork() == 0) {
                setsid();
                take_memory(24);
                for (;;) pause();
            }
            _exit(0);
        }
    }
    for (;;) pause();
}
