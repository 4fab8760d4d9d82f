// promise: A build step cannot use the kernel's key store.
// expect: violation keyctl
// policy: tools
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    forbidden(syscall(SYS_keyctl, 0, -3, 1), "keyctl");
}
