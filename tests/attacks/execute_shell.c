// promise: A submission cannot execute another program.
// expect: violation execve
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    execl("/bin/sh", "sh", "-c", "echo BREACH", NULL);
    breach("execve");
}
