// promise: A submission cannot execute itself again.
// expect: violation execve
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    execv("/proc/self/exe", argv);
    breach("execve");
}
