// promise: Build processes whose main threads have ended count toward the process limit.
// expect: processes or memory
// policy: tools
#include "attack.h"
static void rest(void) {
    for (;;) pause();
}
static void child(void (*rest)(void)) {
    if (fork() == 0) {
        setsid();
        without_leader(rest);
    }
}
int main(int argc, char **argv) {
    begin(argc);
    for (int i = 0; i < 60; i++) child(rest);
    for (;;) pause();
}
