// promise: A thread cannot stop sharing its file descriptors with the others.
// expect: exited 0
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    refused(syscall(SYS_close_range, 100, 200, 2 /* CLOSE_RANGE_UNSHARE */), "close_range");
    refused(syscall(SYS_close_range, 100, 200, 6), "close_range");
    if (syscall(SYS_close_range, 100, 200, 0) != 0 && errno != ENOSYS) return 1;
}
