// promise: A program cannot change its root folder.
// expect: violation chroot
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    forbidden(chroot("."), "chroot");
}
