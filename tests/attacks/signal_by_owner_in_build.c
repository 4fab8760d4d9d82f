// promise: A build step cannot make the kernel signal others for one of its descriptors.
// expect: exited 0
// policy: tools
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    int ends[2];
    if (pipe(ends)) return 1;
    refused(fcntl(ends[0], F_SETOWN, atoi(argv[2])), "F_SETOWN");
    refused(fcntl(ends[0], F_SETSIG, SIGKILL), "F_SETSIG");
}
