// promise: A build step's output beyond its limit is dropped, whichever process prints, until the time is used up.
// expect: cpu or wall
// policy: tools
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    for (int i = 0; i < 4; i++) fork();
    for (;;) write(1, full_block(), sizeof block);
}
