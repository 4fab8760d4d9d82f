// promise: Files that only their owner may read cannot be read.
// expect: exited 0
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    unreadable(in(argv[1], "private.txt"));
    unreadable("/etc/shadow");
}
