// promise: Nameless files of processes whose parents have ended count toward the folder's limit.
// expect: folder
// policy: tools
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    for (int i = 0; i < 6; i++) {
        if (fork() == 0) {
            if (fork() == 0) {
                setsid();
                nameless(2);
                for (;;) pause();
            }
            _exit(0);
        }
    }
    for (;;) pause();
}
