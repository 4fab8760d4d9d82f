// promise: A submission cannot run a shell.
// expect: violation
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    if (system("echo from the shell") != -1) breach("a shell");
}
