// promise: A program cannot execute a file by any descriptor number.
// expect: violation execveat
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    int fd = open(argv[0], O_RDONLY);
    for (int number = 63; number >= 3; number--) dup2(fd, number);
    for (int number = 0; number < 4096; number++) {
        syscall(SYS_execveat, number, "", argv, NULL, AT_EMPTY_PATH);
    }
    breach("execveat");
}
