// promise: The depth of folders is limited in a build step.
// expect: folder
// policy: tools
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    for (int i = 0; i < 60; i++) {
        mkdir("d", 0755);
        chdir("d");
    }
    for (;;) pause();
}
