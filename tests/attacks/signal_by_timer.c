// promise: A program cannot signal others by a timer.
// expect: exited 0
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    timer_t timer;
    struct sigevent event = {.sigev_notify = SIGEV_THREAD_ID, .sigev_signo = SIGKILL};
    event._sigev_un._tid = atoi(argv[2]);
    refused(timer_create(CLOCK_MONOTONIC, &event, &timer), "timer_create");
    event._sigev_un._tid = getppid();
    refused(timer_create(CLOCK_MONOTONIC, &event, &timer), "timer_create");
}
