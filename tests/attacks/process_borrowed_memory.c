// promise: A build process that borrows the memory of its parent and never returns it is killed.
// expect: wall
// policy: tools
// wall: 400
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    if (vfork() == 0) {
        for (;;) pause();
    }
}
