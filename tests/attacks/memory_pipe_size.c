// promise: A program cannot enlarge pipes.
// expect: exited 0
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    int ends[2];
    if (pipe(ends)) return 1;
    refused(fcntl(ends[0], F_SETPIPE_SZ, 1 << 20), "F_SETPIPE_SZ");
}
