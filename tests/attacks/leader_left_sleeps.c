// promise: A program whose main thread has left meets its limit on the clock and is ended immediately.
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
