// promise: A build process that became a child of the supervisor is killed like all others.
// expect: exited 0
// policy: tools
#include "attack.h"
static int for_ever(void *nothing) {
    setsid();
    for (;;) pause();
}
int main(int argc, char **argv) {
    begin(argc);
    static char stack[1 << 16];
    if (clone(for_ever, stack + sizeof stack, CLONE_PARENT, NULL) < 0) return 0;
}
