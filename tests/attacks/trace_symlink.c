// promise: A submission cannot link its trace to a reference.
// expect: exited 0
// leaves: nothing
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    refused(symlink(in(argv[1], "reference.bin"), "trace.bin"), "symlink");
    refused(link(in(argv[1], "reference.bin"), "trace.bin"), "link");
}
