// promise: A program cannot read the environment, memory, descriptors and arguments of other processes.
// expect: exited 0
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    const char *files[] = {"environ", "mem", "maps", "auxv", "io", "syscall", "stack", "pagemap", "cwd/Cargo.toml"};
    int victims[] = {getppid(), atoi(argv[2])};
    for (int i = 0; i < 2; i++) {
        for (int j = 0; j < 9; j++) {
            char path[100];
            snprintf(path, sizeof path, "/proc/%d/%s", victims[i], files[j]);
            int fd = open(path, O_RDONLY);
            char byte;
            if (fd >= 0 && read(fd, &byte, 1) > 0) breach(path);
        }
        char path[100];
        snprintf(path, sizeof path, "/proc/%d/fd", victims[i]);
        if (opendir(path)) breach(path);
    }
}
