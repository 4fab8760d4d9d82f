// promise: A build step cannot mount file systems.
// expect: violation mount
// policy: tools
#include "attack.h"
#include <sys/mount.h>
int main(int argc, char **argv) {
    begin(argc);
    forbidden(mount("none", ".", "tmpfs", 0, NULL), "mount");
}
