// promise: The root folder cannot be changed.
// expect: violation chroot
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    forbidden(chroot("."), "chroot");
}
