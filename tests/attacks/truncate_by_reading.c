// promise: A program cannot empty a file by opening it for reading.
// expect: exited 0
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    refused(open(argv[3], O_RDONLY | O_TRUNC), "the scene");
    refused(open("/proc/self/exe", O_RDONLY | O_TRUNC), "itself");
    put("own", "x");
    refused(open("own", O_RDONLY | O_TRUNC), "O_RDONLY with O_TRUNC");
}
