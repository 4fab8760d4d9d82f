// promise: A program cannot wake a process that waits on a futex in a library's pages, or find out how many processes wait on it.
// expect: exited 0
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    int fd = open(argv[0], O_RDONLY);
    uint32_t *word = mmap(NULL, 4096, PROT_READ, MAP_SHARED, fd, 0);
    if (word == MAP_FAILED) exit(97);
    uint32_t own[2] = {0, 0};
    // A wake of shared words wakes nobody: either it is refused, or it has no effect.
    for (int *wake = (int[]){1, 10, 1 | 256, 10 | 256, 0}; *wake; wake++) {
        if (syscall(SYS_futex, word, *wake, 1, NULL, NULL, -1) > 0) breach("a futex that others share");
        if (syscall(SYS_futex, own, *wake, 1, NULL, NULL, -1) > 0) breach("a futex that others may share");
    }
    for (int op = 2; op <= 13; op++) {
        if (op == 9 || op == 10) continue;
        refused(syscall(SYS_futex, word, op, 1, NULL, word + 1, 0), "a futex that others share");
        refused(syscall(SYS_futex, word, op | 256, 1, NULL, word + 1, 0), "a futex that others share");
        refused(syscall(SYS_futex, own, op, 1, NULL, own + 1, 0), "a futex that others may share");
    }
    // The newer calls: waitv, wake, wait, requeue.
    struct { uint64_t value, address; uint32_t flags, reserved; } waiter = {*word, (uintptr_t)word, 2, 0};
    struct timespec soon = {1, 0};
    refused(syscall(449, &waiter, 1, 0, &soon, CLOCK_MONOTONIC), "futex_waitv");
    refused(syscall(454, word, -1UL, 1, 2), "futex_wake");
    refused(syscall(455, word, (uint64_t)*word, -1UL, 2, &soon, CLOCK_MONOTONIC), "futex_wait");
    refused(syscall(456, &waiter, 0, 1, 1), "futex_requeue");
    // Between threads of its own it may.
    if (syscall(SYS_futex, own, 1 | 128, 1, NULL, NULL, 0)) breach("a private futex is refused");
}
