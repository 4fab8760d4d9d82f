// promise: The number of files is limited, however small they are.
// expect: folder
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    for (int i = 0;; i++) {
        char name[20];
        snprintf(name, sizeof name, "f%d", i);
        int fd = open(name, O_WRONLY | O_CREAT, 0644);
        if (fd >= 0) close(fd);
    }
}
