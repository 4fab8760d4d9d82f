// promise: A program cannot write outside the working folder.
// expect: exited 0
// needs: hidden files
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    const char *folders[] = {"..", "/tmp", "/var/tmp", "/dev/shm", "/run", "/root", "/home", "/etc", "/usr/bin", "/"};
    for (int i = 0; i < 10; i++) {
        char path[100];
        snprintf(path, sizeof path, "%s/fosssim-attack-%d", folders[i], getpid());
        refused(open(path, O_WRONLY | O_CREAT, 0644), path);
        refused(mkdir(path, 0755), path);
    }
}
