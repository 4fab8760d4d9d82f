// promise: Files in removed folders count toward the folder's limit as long as they are open.
// expect: folder
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    for (int i = 0; i < 8; i++) {
        mkdir("d", 0755);
        if (chdir("d")) return 1;
        nameless(2);
        if (chdir("..")) return 1;
        rmdir("d");
    }
    for (;;) pause();
}
