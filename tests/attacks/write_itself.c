// promise: A program cannot replace itself for the next scene.
// expect: exited 0
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    refused(open("/proc/self/exe", O_WRONLY), "/proc/self/exe");
    refused(open(argv[0], O_WRONLY), "open for writing");
    refused(unlink(argv[0]), "unlink");
    put("forged", "#!/bin/true\n");
    refused(rename("forged", argv[0]), "rename");
    refused(chmod(argv[0], 0), "chmod");
}
