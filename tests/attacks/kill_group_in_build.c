// promise: A build step that kills its whole group kills only itself.
// expect: signalled 9
// policy: tools
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    refused(kill(getppid(), SIGKILL), "the supervisor was signalled");
    kill(0, SIGKILL);
    for (;;) pause();
}
