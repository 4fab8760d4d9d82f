// promise: A program whose main thread has ended is killed immediately at its limit on the clock.
// expect: wall
// wall: 500
#include "attack.h"
static void rest(void) {
    for (;;) pause();
}
int main(int argc, char **argv) {
    begin(argc);
    without_leader(rest);
}
