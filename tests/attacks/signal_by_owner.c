// promise: A program cannot make the kernel signal others for one of its descriptors.
// expect: exited 0
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    int ends[2];
    if (pipe(ends)) return 1;
    int victim = atoi(argv[2]);
    refused(fcntl(ends[0], F_SETOWN, victim), "F_SETOWN");
    refused(fcntl(ends[0], F_SETOWN, -getppid()), "F_SETOWN of a group");
    struct f_owner_ex owner = {F_OWNER_PID, victim};
    refused(fcntl(ends[0], F_SETOWN_EX, &owner), "F_SETOWN_EX");
}
