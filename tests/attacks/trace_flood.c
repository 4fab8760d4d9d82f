// promise: An endless trace ends the run at its limit.
// expect: output
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    static char block[1 << 16];
    int fd = open("trace.bin", O_WRONLY | O_CREAT | O_TRUNC, 0644);
    for (;;) write(fd, block, sizeof block);
}
