// promise: A submission cannot execute an open file.
// expect: violation execveat
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    int fd = open(argv[0], O_RDONLY);
    syscall(SYS_execveat, fd, "", argv, NULL, AT_EMPTY_PATH);
    breach("execveat");
}
