// promise: A program cannot read references by their path.
// expect: exited 0
// needs: hidden files
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    unreadable(in(argv[1], "reference.bin"));
    unreadable(in(argv[1], "private.txt"));
    unreadable(in(argv[1], "inner/more.txt"));
    if (opendir(argv[1])) breach("the folder can be listed");
}
