// promise: The processor time of children that have ended counts toward the limit.
// expect: cpu
// policy: tools
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    for (;;) {
        if (fork() == 0) {
            for (volatile int i = 0; i < 5000000; i++) {
            }
            _exit(0);
        }
        wait(NULL);
    }
}
