// promise: Files that only a child process of a build step has mapped count toward the folder's limit.
// expect: folder
// policy: tools
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    for (int i = 0; i < 6; i++) {
        if (fork() == 0) {
            int fd = nameless(2);
            mmap(NULL, 2 << 20, PROT_READ, MAP_SHARED, fd, 0);
            close(fd);
            for (;;) pause();
        }
    }
    for (;;) pause();
}
