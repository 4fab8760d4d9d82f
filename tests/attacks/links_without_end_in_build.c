// promise: Links count toward the file limit.
// expect: folder
// policy: tools
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    char target[4000], name[20];
    memset(target, 'x', sizeof target - 1);
    target[sizeof target - 1] = 0;
    for (int i = 0; i < 5000; i++) {
        snprintf(name, sizeof name, "l%d", i);
        symlink(target, name);
    }
    for (;;) pause();
}
