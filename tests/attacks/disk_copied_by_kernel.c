// promise: Bytes that the kernel copies count toward the folder's limit.
// expect: folder
#include "attack.h"
#include <sys/sendfile.h>
int main(int argc, char **argv) {
    begin(argc);
    signal(SIGXFSZ, SIG_IGN);
    int from = open("from", O_RDWR | O_CREAT, 0644);
    for (int j = 0; j < 16; j++) write(from, full_block(), sizeof block);
    for (int i = 0; i < 16; i++) {
        char name[20];
        snprintf(name, sizeof name, "to%d", i);
        int to = open(name, O_WRONLY | O_CREAT, 0644);
        off_t start = 0;
        sendfile(to, from, &start, 1 << 20);
    }
    for (;;) pause();
}
