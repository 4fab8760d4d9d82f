// promise: Descriptors of signals, timers and events count as files and are limited as such.
// expect: exited 0
#include "attack.h"
#include <sys/epoll.h>
#include <sys/eventfd.h>
#include <sys/timerfd.h>
int main(int argc, char **argv) {
    begin(argc);
    int count = 0;
    sigset_t all;
    sigfillset(&all);
    refused(syscall(SYS_signalfd4, -1, &all, 8, 0), "signalfd");
    while (timerfd_create(CLOCK_MONOTONIC, 0) >= 0 && eventfd(0, 0) >= 0 && epoll_create1(0) >= 0) count++;
    if (count > 40) breach("more descriptors than the limit");
}
