// promise: A program cannot choose which signal the kernel sends for a descriptor.
// expect: exited 0
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    int ends[2];
    if (pipe(ends)) return 1;
    refused(fcntl(ends[0], F_SETSIG, SIGKILL), "F_SETSIG");
    refused(fcntl(ends[0], F_SETFL, O_ASYNC), "O_ASYNC");
}
