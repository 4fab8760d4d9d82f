// promise: A program cannot use the kernel's key store.
// expect: violation keyctl
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    forbidden(syscall(SYS_keyctl, 0, -3, 0), "keyctl");
}
