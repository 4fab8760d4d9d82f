// promise: A program cannot read the memory of other processes.
// expect: violation process_vm_readv
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    char byte;
    struct iovec here = {&byte, 1}, there = {(void *)main, 1};
    forbidden(process_vm_readv(getppid(), &here, 1, &there, 1, 0), "process_vm_readv");
}
