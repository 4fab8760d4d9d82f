// promise: A submission cannot execute what it has written.
// expect: violation execveat
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    int fd = open("tool", O_WRONLY | O_CREAT, 0755);
    write(fd, "#!/bin/sh\necho BREACH\n", 22);
    close(fd);
    char *none[] = {NULL};
    syscall(SYS_execveat, AT_FDCWD, "tool", none, none, 0);
    breach("execveat");
}
