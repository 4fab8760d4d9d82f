// promise: A program cannot use the asynchronous calls (io_uring).
// expect: violation io_uring_setup
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    char parameters[256] = {0};
    forbidden(syscall(SYS_io_uring_setup, 4, parameters), "io_uring_setup");
}
