// promise: A program cannot signal all processes at the same time.
// expect: exited 0
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    if (getuid() == 0) breach("it runs as root");
    refused(kill(-1, SIGKILL), "kill of everybody");
}
