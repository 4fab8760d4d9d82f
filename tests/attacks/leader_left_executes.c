// promise: A program whose main thread has ended cannot execute another.
// expect: violation execve
#include "attack.h"
static void rest(void) {
    execl("/bin/sh", "sh", (char *)NULL);
    breach("execve");
}
int main(int argc, char **argv) {
    begin(argc);
    without_leader(rest);
}
