// promise: Output on standard error beyond its limit is read and dropped, until the time is used up.
// expect: cpu or wall
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    for (;;) fputs("warning: negative mass\n", stderr);
}
