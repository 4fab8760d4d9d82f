// promise: A file cannot grow beyond the folder's limit.
// expect: folder
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    static char block[1 << 16];
    memset(block, 1, sizeof block);
    int fd = open("big", O_WRONLY | O_CREAT, 0644);
    for (;;) write(fd, block, sizeof block);
}
