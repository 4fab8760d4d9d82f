// promise: A program cannot have nameless shared memory by the newer name of the same mapping.
// expect: exited 0
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    int flags = 0x03 | MAP_ANONYMOUS; // MAP_SHARED_VALIDATE
    if (mmap(NULL, 50 << 20, PROT_READ | PROT_WRITE, flags, -1, 0) != MAP_FAILED) breach("shared memory");
}
