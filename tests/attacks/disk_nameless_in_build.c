// promise: The nameless files of every process of a build step count toward the folder's limit.
// expect: folder
// policy: tools
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    for (int i = 0; i < 6; i++) {
        if (fork() == 0) {
            nameless(2);
            for (;;) pause();
        }
    }
    for (;;) pause();
}
