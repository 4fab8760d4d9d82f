// promise: Standard output is limited to the byte.
// expect: output stdout
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    static char block[1 << 16];
    memset(block, 'x', sizeof block);
    for (;;) write(1, block, sizeof block);
}
