// promise: The memory of a build process that became a child of the supervisor counts toward the limit.
// expect: memory
// policy: tools
#include "attack.h"
static int for_ever(void *nothing) {
    setsid();
    take_memory(24);
    for (;;) pause();
}
int main(int argc, char **argv) {
    begin(argc);
    static char stack[1 << 16];
    for (int i = 0; i < 6; i++) clone(for_ever, stack + sizeof stack, CLONE_PARENT, NULL);
    for (;;) pause();
}
