// promise: The working folder as a whole is limited, whether or not a program ignores the file size signal.
// expect: folder
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    signal(SIGXFSZ, SIG_IGN);
    static char block[1 << 16];
    memset(block, 1, sizeof block);
    for (int i = 0;; i++) {
        char name[20];
        snprintf(name, sizeof name, "big%d", i % 50);
        int fd = open(name, O_WRONLY | O_CREAT, 0644);
        while (write(fd, block, sizeof block) > 0) {
        }
        close(fd);
    }
}
