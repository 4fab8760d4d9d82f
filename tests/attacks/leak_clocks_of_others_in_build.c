// promise: Nor can a build step ask for the time of others.
// expect: exited 0
// policy: tools
#include "attack.h"
#include <sys/timerfd.h>
int main(int argc, char **argv) {
    begin(argc);
    int processes[] = {atoi(argv[2]), getppid(), 1, 0x3fffff};
    struct timespec time;
    for (int i = 0; i < 4; i++) {
        for (int kind = 0; kind < 4; kind++) {
            clockid_t clock = (~(unsigned)processes[i] << 3) | kind;
            refused(syscall(SYS_clock_gettime, clock, &time), "clock_gettime");
            refused(syscall(SYS_clock_getres, clock, &time), "clock_getres");
            struct timespec short_time = {0, 1};
            refused(syscall(SYS_clock_nanosleep, clock, 0, &short_time, NULL) ? -1 : 0, "clock_nanosleep");
            timer_t timer;
            struct sigevent none = {.sigev_notify = SIGEV_NONE};
            refused(syscall(SYS_timer_create, clock, &none, &timer), "timer_create");
            refused(timerfd_create(clock, 0), "timerfd_create");
        }
    }
    for (clockid_t clock = 0; clock < 12; clock++) syscall(SYS_clock_gettime, clock, &time);
    if (clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time) || clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time)) breach("no time of its own");
    clockid_t own;
    if (clock_getcpuclockid(0, &own) || clock_gettime(own, &time) || pthread_getcpuclockid(pthread_self(), &own) || clock_gettime(own, &time)) breach("no time of its own by number");
}
