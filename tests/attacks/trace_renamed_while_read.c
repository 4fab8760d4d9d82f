// promise: A trace that changes its name while it is written is read to its end.
// expect: exited 0
// pipe: 6
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    int fd = open("trace.bin", O_WRONLY);
    char name[2][20] = {"trace.bin", "moved"};
    for (int i = 0; i < 3; i++) {
        write(fd, "ab", 2);
        rename(name[i % 2], name[(i + 1) % 2]);
    }
}
