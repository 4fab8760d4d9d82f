// promise: A trace that was moved away is not collected, and its bytes count toward the folder's limit.
// expect: folder
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    char name[20];
    for (int i = 0; i < 40; i++) {
        int fd = open("trace.bin", O_WRONLY | O_CREAT, 0644);
        for (int j = 0; j < 4; j++) write(fd, full_block(), sizeof block);
        close(fd);
        snprintf(name, sizeof name, "moved%d", i);
        rename("trace.bin", name);
    }
    for (;;) pause();
}
