// promise: A program cannot use shared memory without a file by the newer mapping type (MAP_SHARED_VALIDATE).
// expect: exited 0
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    int flags = 0x03 | MAP_ANONYMOUS; // MAP_SHARED_VALIDATE
    if (mmap(NULL, 50 << 20, PROT_READ | PROT_WRITE, flags, -1, 0) != MAP_FAILED) breach("shared memory");
}
