// promise: A program cannot load programs into the kernel (BPF).
// expect: violation bpf
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    char attributes[128] = {0};
    forbidden(syscall(SYS_bpf, 0, attributes, sizeof attributes), "bpf");
}
