// promise: A program whose main thread has left and that ignores every signal is ended.
// expect: wall
// wall: 400
#include "attack.h"
static void rest(void) {
    sigset_t all;
    sigfillset(&all);
    sigprocmask(SIG_BLOCK, &all, NULL);
    for (;;) pause();
}
int main(int argc, char **argv) {
    begin(argc);
    without_leader(rest);
}
