// promise: The mapped files of a program whose main thread has ended count toward the folder's limit.
// expect: folder
#include "attack.h"
static void rest(void) {
    for (int i = 0; i < 8; i++) {
        int fd = nameless(2);
        mmap(NULL, 2 << 20, PROT_READ, MAP_SHARED, fd, 0);
        close(fd);
    }
    for (;;) pause();
}
int main(int argc, char **argv) {
    begin(argc);
    without_leader(rest);
}
