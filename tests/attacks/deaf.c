// promise: A program that blocks and ignores every signal is also killed.
// expect: wall
// wall: 300
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    sigset_t all;
    sigfillset(&all);
    sigprocmask(SIG_BLOCK, &all, NULL);
    for (int signal_number = 1; signal_number < 65; signal_number++) signal(signal_number, SIG_IGN);
    for (;;) pause();
}
