// promise: The memory limit applies to a program whose main thread has ended.
// expect: memory
#include "attack.h"
static void rest(void) {
    take_memory(400);
    for (;;) pause();
}
int main(int argc, char **argv) {
    begin(argc);
    without_leader(rest);
}
