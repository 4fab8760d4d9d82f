// promise: A program cannot use up the timers of its user.
// expect: exited 0
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    for (int i = 0; i < 20000; i++) {
        timer_t timer;
        struct sigevent event = {.sigev_notify = SIGEV_SIGNAL, .sigev_signo = SIGUSR1};
        if (timer_create(CLOCK_MONOTONIC, &event, &timer)) return 0;
    }
    breach("20000 timers");
}
