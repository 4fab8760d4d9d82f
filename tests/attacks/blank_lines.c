// promise: Endless blank lines are limited like any other output.
// expect: cpu or wall
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    for (;;) putchar('\n');
}
