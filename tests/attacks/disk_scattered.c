// promise: The blocks of a file count toward the folder's limit, and the holes between them do not.
// expect: folder
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    signal(SIGXFSZ, SIG_IGN);
    char name[20];
    for (int i = 0; i < 8; i++) {
        snprintf(name, sizeof name, "f%d", i);
        int fd = open(name, O_WRONLY | O_CREAT, 0644);
        for (off_t at = 0; at < 4 << 20; at += 8192) pwrite(fd, "x", 1, at);
        close(fd);
    }
    for (;;) pause();
}
