// promise: A program cannot give files attributes, which would take kernel memory without a limit.
// expect: exited 0
#include "attack.h"
#include <sys/xattr.h>
int main(int argc, char **argv) {
    begin(argc);
    put("file", "x");
    int fd = open("file", O_RDWR);
    refused(setxattr("file", "user.hoard", full_block(), 60000, 0), "setxattr");
    refused(fsetxattr(fd, "user.hoard", full_block(), 60000, 0), "fsetxattr");
    refused(lsetxattr("file", "system.posix_acl_access", full_block(), 44, 0), "an access list");
    refused(syscall(463, AT_FDCWD, "file", 0, "user.hoard", block, 8), "setxattrat");
}
