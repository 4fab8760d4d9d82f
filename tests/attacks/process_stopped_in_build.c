// promise: Build processes that have stopped are killed.
// expect: exited 0
// policy: tools
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    for (int i = 0; i < 3; i++) {
        if (fork() == 0) {
            setsid();
            raise(SIGSTOP);
            for (;;) pause();
        }
    }
    usleep(50000);
}
