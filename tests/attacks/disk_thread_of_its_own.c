// promise: A thread cannot have separate descriptors, which would hide files.
// expect: violation clone
#include "attack.h"
static int alone(void *nothing) {
    for (;;) pause();
}
int main(int argc, char **argv) {
    begin(argc);
    static char stack[1 << 16];
    int flags = CLONE_VM | CLONE_FS | CLONE_SIGHAND | CLONE_THREAD | CLONE_SYSVSEM;
    clone(alone, stack + sizeof stack, flags, NULL);
    breach("a thread without CLONE_FILES");
}
