// What the hostile programs share. They run inside the sandbox only: elsewhere they refuse.
//
// Arguments: 1 a folder with secrets, 2 a process of the grader's user, 3 a scene that may be read and not changed,
// 4 the folder of another submission.
#define _GNU_SOURCE
#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <pthread.h>
#include <sched.h>
#include <signal.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/time.h>
#include <sys/types.h>
#include <sys/uio.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

// Refuses to go on outside the sandbox. Flags that others set, too (no_new_privs, any seccomp filter), are not enough:
// only our filter answers a plain Unix socket with EACCES, and root is never sandboxed.
static void begin(int argc) {
    int ours = prctl(PR_GET_NO_NEW_PRIVS, 0, 0, 0, 0) == 1 && prctl(PR_GET_SECCOMP, 0, 0, 0, 0) == 2;
    errno = 0;
    ours = ours && socket(AF_UNIX, SOCK_STREAM, 0) == -1 && errno == EACCES;
    if (argc < 5 || !getenv("FOSSSIM_ATTACK") || !ours || getuid() == 0 || geteuid() == 0) {
        fputs("this program attacks its machine; it runs inside the sandbox only\n", stderr);
        exit(98);
    }
}

// The attack worked: exit code 66 and the reason.
static void breach(const char *what) {
    printf("BREACH: %s\n", what);
    fflush(stdout);
    _exit(66);
}

// A call that must fail.
static void refused(long answer, const char *what) {
    if (answer != -1) breach(what);
}

// A file that must not be readable.
static void unreadable(const char *path) {
    int fd = open(path, O_RDONLY | O_NONBLOCK);
    if (fd >= 0) {
        char text[200];
        ssize_t length = read(fd, text, sizeof text - 1);
        if (length > 0) {
            text[length] = 0;
            puts(text);
        }
        breach(path);
    }
}

// A path inside a folder.
static const char *in(const char *folder, const char *name) {
    static char path[PATH_MAX];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    return path;
}

// Writes a whole file.
static void put(const char *name, const char *text) {
    int fd = open(name, O_WRONLY | O_CREAT | O_TRUNC, 0644);
    if (fd < 0 || write(fd, text, strlen(text)) < 0) exit(97);
    close(fd);
}

// Spins for ever.
static void spin(void) {
    for (volatile unsigned long i = 0;; i++) {
    }
}
