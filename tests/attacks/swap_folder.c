// promise: A program cannot mislead the grader by swapping folders and links while the grader reads them.
// expect: wall
// policy: tools
// wall: 400
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    mkdir("real", 0755);
    put("real/file", "x");
    symlink(argv[1], "link");
    for (;;) {
        rename("real", "shown");
        rename("shown", "real");
        rename("link", "shown");
        rename("shown", "link");
        usleep(50);
    }
}
