// promise: The output of a build step is limited to the byte, whoever prints.
// expect: output stdout
// policy: tools
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    for (int i = 0; i < 4; i++) fork();
    for (;;) write(1, full_block(), sizeof block);
}
