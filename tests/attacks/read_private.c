// promise: A program cannot read files that only their owner may read.
// expect: exited 0
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    unreadable(in(argv[1], "private.txt"));
    unreadable("/etc/shadow");
}
