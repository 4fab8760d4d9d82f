// promise: The kernel's key store is closed.
// expect: violation keyctl
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    syscall(SYS_keyctl, 0, -3, 0);
    breach("keyctl");
}
