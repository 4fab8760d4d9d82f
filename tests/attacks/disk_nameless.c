// promise: Open files that were removed count toward the folder's limit.
// expect: folder
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    signal(SIGXFSZ, SIG_IGN);
    static char block[1 << 16];
    memset(block, 1, sizeof block);
    for (int i = 0; i < 16; i++) {
        int fd = open("hidden", O_WRONLY | O_CREAT, 0644);
        unlink("hidden");
        for (int j = 0; j < 32; j++) write(fd, block, sizeof block);
    }
    for (;;) pause();
}
