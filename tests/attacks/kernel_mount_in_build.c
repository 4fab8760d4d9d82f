// promise: A build step can mount nothing.
// expect: violation mount
// policy: tools
#include "attack.h"
#include <sys/mount.h>
int main(int argc, char **argv) {
    begin(argc);
    forbidden(mount("none", ".", "tmpfs", 0, NULL), "mount");
}
