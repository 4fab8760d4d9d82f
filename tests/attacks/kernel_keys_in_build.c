// promise: The kernel's key store is closed to build steps.
// expect: violation keyctl
// policy: tools
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    forbidden(syscall(SYS_keyctl, 0, -3, 1), "keyctl");
}
