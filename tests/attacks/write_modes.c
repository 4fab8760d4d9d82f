// promise: A program cannot change permission bits, owners, times and attributes of the grader's files.
// expect: exited 0
#include "attack.h"
#include <sys/xattr.h>
int main(int argc, char **argv) {
    begin(argc);
    char secret[PATH_MAX];
    snprintf(secret, sizeof secret, "%s", in(argv[1], "reference.bin"));
    const char *paths[] = {argv[1], secret, argv[3]};
    for (int i = 0; i < 3; i++) {
        refused(chmod(paths[i], 0777), "chmod");
        refused(fchmodat(AT_FDCWD, paths[i], 0777, 0), "fchmodat");
        refused(syscall(452, AT_FDCWD, paths[i], 0777, 0), "fchmodat2");
        refused(chown(paths[i], getuid(), getgid()), "chown");
        refused(lchown(paths[i], getuid(), getgid()), "lchown");
        refused(utimensat(AT_FDCWD, paths[i], NULL, 0), "utimensat");
        refused(syscall(SYS_setxattr, paths[i], "user.mark", "x", 1, 0), "setxattr");
    }
    int scene = open(argv[3], O_RDONLY);
    if (scene < 0) breach("the scene cannot be read");
    refused(fchmod(scene, 0777), "fchmod");
    refused(futimens(scene, NULL), "futimens");
    refused(fchown(scene, getuid(), getgid()), "fchown");
    refused(ftruncate(scene, 0), "ftruncate");
}
