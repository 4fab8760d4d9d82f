// promise: A build step that ends its whole group ends only itself.
// expect: signalled 9
// policy: tools
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    refused(kill(getppid(), SIGKILL), "the supervisor was signalled");
    kill(0, SIGKILL);
    for (;;) pause();
}
