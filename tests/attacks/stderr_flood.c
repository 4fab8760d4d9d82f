// promise: A flood on standard error is read and dropped beyond its limit, until the time is used up.
// expect: cpu or wall
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    for (;;) fputs("warning: negative mass\n", stderr);
}
