// promise: Swapping folders and links while the grader looks leads it nowhere.
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
