// promise: A build step cannot empty a file that it may only read.
// expect: exited 0
// policy: tools
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    refused(open(argv[3], O_RDONLY | O_TRUNC), "the scene");
    refused(open(in(argv[1], "reference.bin"), O_RDONLY | O_TRUNC), "a reference");
}
