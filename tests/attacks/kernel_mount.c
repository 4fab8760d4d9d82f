// promise: A program cannot mount file systems.
// expect: violation mount
#include "attack.h"
#include <sys/mount.h>
int main(int argc, char **argv) {
    begin(argc);
    forbidden(mount("none", ".", "tmpfs", 0, ""), "mount");
}
