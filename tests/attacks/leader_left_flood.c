// promise: A program whose main thread has ended cannot flood standard output beyond its time limit.
// expect: cpu or wall
#include "attack.h"
static void rest(void) {
    for (;;) write(1, full_block(), sizeof block);
}
int main(int argc, char **argv) {
    begin(argc);
    without_leader(rest);
}
