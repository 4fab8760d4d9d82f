// promise: A program cannot open files through the links of /proc that it cannot open directly.
// expect: exited 0
// needs: hidden files
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    const char *roots[] = {"/proc/self/root", "/proc/thread-self/root", "/proc/self/cwd/../../../../../../../../.."};
    for (int i = 0; i < 3; i++) {
        char path[PATH_MAX];
        snprintf(path, sizeof path, "%s%s/reference.bin", roots[i], argv[1]);
        unreadable(path);
    }
    unreadable("/proc/self/cwd/../secrets/reference.bin");
}
