// promise: A link with the trace's name is not followed.
// expect: exited 0
// policy: tools
// leaves: refused
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    return symlink(in(argv[1], "reference.bin"), "trace.bin");
}
