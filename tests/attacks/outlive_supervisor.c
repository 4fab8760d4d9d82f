// promise: A program cannot arrange to outlive its supervisor.
// expect: exited 0
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    int signal_number = 0;
    prctl(PR_GET_PDEATHSIG, &signal_number, 0, 0, 0);
    if (signal_number != SIGKILL) breach("it does not die with its supervisor");
    refused(prctl(PR_SET_PDEATHSIG, 0, 0, 0, 0), "prctl");
    refused(prctl(PR_SET_DUMPABLE, 0, 0, 0, 0), "it can hide from its supervisor");
    refused(prctl(PR_SET_CHILD_SUBREAPER, 1, 0, 0, 0), "it can adopt processes");
}
