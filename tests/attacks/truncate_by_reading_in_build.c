// promise: Nor can a build step empty one.
// expect: exited 0
// policy: tools
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    refused(open(argv[3], O_RDONLY | O_TRUNC), "the scene");
    refused(open(in(argv[1], "reference.bin"), O_RDONLY | O_TRUNC), "a reference");
}
