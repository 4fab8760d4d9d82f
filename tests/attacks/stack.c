// promise: A stack that grows without limit crashes the program and affects no other process.
// expect: signalled 11
#include "attack.h"
static int deeper(volatile char *above) {
    volatile char here[4096];
    here[0] = above[0];
    return deeper(here) + here[1];
}
int main(int argc, char **argv) {
    begin(argc);
    char start[1] = {1};
    return deeper(start);
}
