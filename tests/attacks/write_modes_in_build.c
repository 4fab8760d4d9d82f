// promise: A build step can change permission bits only in its own folder.
// expect: exited 0
// policy: tools
// needs: named violations
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    char secret[PATH_MAX], own[PATH_MAX + 10];
    snprintf(secret, sizeof secret, "%s", in(argv[1], "reference.bin"));
    put("tool", "#!/bin/sh\n");
    if (chmod("tool", 0755) != 0) return 1;
    if (chmod("./tool", 0700) != 0) return 2;
    char here[PATH_MAX];
    if (!getcwd(here, sizeof here)) return 3;
    snprintf(own, sizeof own, "%s/tool", here);
    if (getuid() == geteuid() && access(own, F_OK) == 0 && chmod(own, 0711) != 0) return 4;
    int fd = open("tool", O_RDONLY);
    if (fchmod(fd, 0755) != 0) return 5;
    refused(chmod(argv[1], 0777), "chmod");
    refused(chmod(secret, 0777), "chmod");
    refused(chmod(argv[3], 0777), "chmod of the scene");
    refused(chmod("../secrets", 0777), "chmod upwards");
    refused(fchmodat(AT_FDCWD, "../secrets/reference.bin", 0777, 0), "fchmodat");
    symlink(secret, "way");
    refused(chmod("way", 0777), "chmod through a link");
    int scene = open(argv[3], O_RDONLY);
    refused(fchmod(scene, 0777), "fchmod");
}
