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

// A call that the sandbox forbids on pain of ending the program. Where another filter lies around the sandbox, as in a
// container, it may be refused instead: exit code 77.
static void forbidden(long answer, const char *what) {
    if (answer != -1 || (errno != EPERM && errno != ENOSYS && errno != EACCES)) breach(what);
    _exit(77);
}

// Goes on in another thread after the main thread has left: the process then looks dead from outside.
static volatile int main_thread_is_here = 1;
static void *leave_and_go_on(void *rest) {
    while (main_thread_is_here) sched_yield();
    ((void (*)(void))rest)();
    return NULL;
}
static void without_leader(void (*rest)(void)) {
    pthread_t thread;
    // The kernel clears the word when the main thread has let go of its memory.
    syscall(SYS_set_tid_address, &main_thread_is_here);
    if (pthread_create(&thread, NULL, leave_and_go_on, (void *)rest)) exit(97);
    syscall(SYS_exit, 0);
}

// A block of bytes that are not zero.
static char block[1 << 16];
static void *full_block(void) {
    memset(block, 1, sizeof block);
    return block;
}

// Memory that is in use.
static void take_memory(size_t mebibytes) {
    for (size_t i = 0; i < mebibytes; i++) {
        char *part = mmap(NULL, 1 << 20, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
        if (part == MAP_FAILED) break;
        memset(part, 1, 1 << 20);
    }
}

// A file of so many mebibytes that has no name any more, open.
static int nameless(int mebibytes) {
    signal(SIGXFSZ, SIG_IGN);
    // Of its own: processes that open one name before any of them has removed it would share one file.
    char name[32];
    snprintf(name, sizeof name, "hidden-%d", getpid());
    int fd = open(name, O_RDWR | O_CREAT, 0644);
    unlink(name);
    for (int i = 0; i < 16 * mebibytes; i++) write(fd, full_block(), sizeof block);
    return fd;
}

// A file that must not be readable.
static void unreadable(const char *path) {
    int fd = open(path, O_RDONLY | O_NONBLOCK);
    struct stat about;
    // Container engines put /dev/null in the place of a file that they hide.
    int hidden = fd >= 0 && !fstat(fd, &about) && S_ISCHR(about.st_mode) && about.st_rdev == 0x103;
    if (hidden) {
        close(fd);
    } else if (fd >= 0) {
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
