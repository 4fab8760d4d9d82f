// promise: A program that stops itself is killed at its time limit.
// expect: wall
// wall: 300
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    raise(SIGSTOP);
    for (;;) pause();
}
