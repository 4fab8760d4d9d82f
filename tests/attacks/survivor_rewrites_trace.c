// promise: A child that continues after the program's end cannot change the collected trace.
// expect: exited 0
// policy: tools
// leaves: honest
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    put("trace.bin", "honest");
    int pipe_ends[2];
    pipe(pipe_ends);
    if (fork() == 0) {
        setsid();
        close(pipe_ends[1]);
        // The end of this pipe is the end of the program.
        char byte;
        read(pipe_ends[0], &byte, 1);
        // Long enough for the grader to collect, had it not waited for this process's death.
        sleep(1);
        for (;;) put("trace.bin", "forged");
    }
    return 0;
}
