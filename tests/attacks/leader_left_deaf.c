// promise: A program that ignores every signal is killed even if its main thread has ended.
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
