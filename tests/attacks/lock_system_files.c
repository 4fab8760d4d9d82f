// promise: A program cannot lock files of the system, which others would notice.
// expect: exited 0
#include "attack.h"
#include <sys/file.h>
int main(int argc, char **argv) {
    begin(argc);
    for (const char **path = (const char *[]){"/dev/null", "/proc/self/exe", argv[3], NULL}; *path; path++) {
        int fd = open(*path, O_RDONLY);
        if (fd < 0) continue;
        refused(flock(fd, LOCK_EX | LOCK_NB), "flock");
        refused(flock(fd, LOCK_SH | LOCK_NB), "flock");
        struct flock lock = {.l_type = F_RDLCK, .l_whence = SEEK_SET};
        refused(fcntl(fd, F_SETLK, &lock), "F_SETLK");
        refused(fcntl(fd, F_OFD_SETLK, &lock), "F_OFD_SETLK");
        refused(fcntl(fd, F_GETLK, &lock), "F_GETLK");
        refused(fcntl(fd, F_OFD_GETLK, &lock), "F_OFD_GETLK");
    }
}
