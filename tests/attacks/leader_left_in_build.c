// promise: A build step cannot leave a daemon whose main thread has ended.
// expect: exited 0
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
    for (int i = 0; i < 3; i++) child(rest);
    usleep(100000);
}
