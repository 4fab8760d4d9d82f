// promise: A program that waits in the kernel, and that none of its own signals wakes, is killed.
// expect: wall
// wall: 300
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    sigset_t all;
    sigfillset(&all);
    sigprocmask(SIG_BLOCK, &all, NULL);
    int ends[2];
    pipe(ends);
    char byte;
    for (;;) read(ends[0], &byte, 1);
}
