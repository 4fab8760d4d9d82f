// promise: Endless blank lines are a flood like any other.
// expect: output stdout
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    for (;;) putchar('\n');
}
