// promise: Output on standard output beyond its limit is read and dropped, until the time is used up.
// expect: cpu or wall
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    static char block[1 << 16];
    memset(block, 'x', sizeof block);
    for (;;) write(1, block, sizeof block);
}
