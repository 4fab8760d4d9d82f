// promise: A program cannot fill the kernel with locks.
// expect: exited 0
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    int fd = open("locked", O_RDWR | O_CREAT, 0644);
    for (long i = 0; i < 100; i++) {
        struct flock lock = {.l_type = F_WRLCK, .l_whence = SEEK_SET, .l_start = 2 * i, .l_len = 1};
        refused(fcntl(fd, F_SETLK, &lock), "F_SETLK");
        lock.l_pid = 0;
        refused(fcntl(fd, F_OFD_SETLK, &lock), "F_OFD_SETLK");
    }
}
