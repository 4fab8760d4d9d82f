// promise: A program that stops itself is ended by the clock.
// expect: wall
// wall: 300
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    raise(SIGSTOP);
    for (;;) pause();
}
