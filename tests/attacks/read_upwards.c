// promise: A program cannot leave the working folder through the folder above.
// expect: exited 0
// needs: file rules
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    unreadable("../secrets/reference.bin");
    if (opendir("..")) breach("..");
    chdir("..");
    unreadable("secrets/reference.bin");
    if (chdir("secrets") == 0) unreadable("reference.bin");
    chdir("/");
    if (opendir(".")) breach("/");
}
