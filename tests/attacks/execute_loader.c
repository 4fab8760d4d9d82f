// promise: A submission cannot make the system's loader run another file.
// expect: violation execve
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    char *words[] = {"ld", argv[0], NULL};
    execv("/lib64/ld-linux-x86-64.so.2", words);
    breach("execve");
}
