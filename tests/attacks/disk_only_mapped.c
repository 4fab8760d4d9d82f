// promise: Files that are neither named nor open, but mapped, count toward the folder's limit.
// expect: folder
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    for (int i = 0; i < 8; i++) {
        int fd = nameless(2);
        if (mmap(NULL, 2 << 20, PROT_READ, MAP_SHARED, fd, 0) == MAP_FAILED) return 1;
        close(fd);
    }
    for (;;) pause();
}
