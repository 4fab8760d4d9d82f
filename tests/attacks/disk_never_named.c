// promise: Files that never had a name count toward the folder's limit.
// expect: folder
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    signal(SIGXFSZ, SIG_IGN);
    for (int i = 0; i < 8; i++) {
        int fd = open(".", O_TMPFILE | O_RDWR, 0600);
        if (fd < 0) fd = nameless(0);
        for (int j = 0; j < 32; j++) write(fd, full_block(), sizeof block);
    }
    for (;;) pause();
}
