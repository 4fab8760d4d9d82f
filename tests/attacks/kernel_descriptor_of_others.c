// promise: A program cannot take descriptors from other processes.
// expect: violation pidfd_getfd
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    forbidden(syscall(SYS_pidfd_getfd, 0, 0, 0), "pidfd_getfd");
}
