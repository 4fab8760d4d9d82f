// promise: Files cannot be linked into the folder from outside, or out of the folder.
// expect: exited 0
// policy: tools
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    put("file", "x");
    refused(link(in(argv[1], "reference.bin"), "mine"), "a link to a secret");
    refused(link(argv[3], "scene"), "a link to the scene");
    refused(linkat(AT_FDCWD, in(argv[1], "reference.bin"), AT_FDCWD, "followed", AT_SYMLINK_FOLLOW), "a link that follows");
    refused(link("file", in(argv[4], "planted")), "a link out of the folder");
    refused(rename("file", in(argv[4], "planted")), "a way out of the folder");
    return link("file", "other name");
}
