// promise: A build step cannot have more processes than its limit.
// expect: processes
// policy: tools
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    for (;;) {
        if (fork() < 0) pause();
    }
}
