// promise: A build step can signal only its own processes.
// expect: exited 0
// policy: tools
// needs: signal scope
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    if (getuid() == 0) breach("it runs as root");
    if (fork() == 0) {
        for (;;) pause();
    }
    refused(kill(getppid(), SIGTERM), "kill of the supervisor");
    refused(kill(atoi(argv[2]), SIGTERM), "kill of the grader");
    // Reaches the child above, and nobody else: the grader checks.
    kill(-1, SIGKILL);
    return wait(NULL) > 0 ? 0 : 1;
}
