// promise: A build step can lock only files of its own folder.
// expect: exited 0
// policy: tools
// needs: named violations
#include "attack.h"
#include <sys/file.h>
int main(int argc, char **argv) {
    begin(argc);
    put("own", "x");
    int own = open("own", O_RDWR);
    struct flock lock = {.l_type = F_WRLCK, .l_whence = SEEK_SET};
    if (flock(own, LOCK_EX | LOCK_NB) != 0) return 1;
    if (fcntl(own, F_SETLK, &lock) != 0) return 2;
    lock.l_type = F_RDLCK;
    for (const char **path = (const char *[]){"/dev/null", "/bin/sh", "/etc/passwd", argv[3], NULL}; *path; path++) {
        int fd = open(*path, O_RDONLY);
        if (fd < 0) continue;
        refused(flock(fd, LOCK_EX | LOCK_NB), "flock");
        refused(fcntl(fd, F_SETLK, &lock), "F_SETLK");
        refused(fcntl(fd, F_OFD_SETLK, &lock), "F_OFD_SETLK");
    }
}
