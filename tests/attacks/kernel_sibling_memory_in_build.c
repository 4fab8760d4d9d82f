// promise: A build step cannot read the memory of its own processes by system call.
// expect: violation process_vm_readv
// policy: tools
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    pid_t child = fork();
    if (child == 0) {
        for (;;) pause();
    }
    char text[16];
    struct iovec here = {text, sizeof text}, there = {full_block, sizeof text};
    forbidden(process_vm_readv(child, &here, 1, &there, 1, 0), "process_vm_readv of a child");
}
