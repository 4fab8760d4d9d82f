// promise: A build step cannot give files attributes or access lists.
// expect: exited 0
// policy: tools
#include "attack.h"
#include <sys/xattr.h>
int main(int argc, char **argv) {
    begin(argc);
    put("file", "x");
    refused(setxattr("file", "user.hoard", full_block(), 60000, 0), "setxattr");
    refused(setxattr("file", "security.capability", full_block(), 20, 0), "a capability");
    refused(setxattr(".", "system.posix_acl_default", full_block(), 44, 0), "an access list");
    refused(syscall(463, AT_FDCWD, "file", 0, "user.hoard", block, 8), "setxattrat");
}
