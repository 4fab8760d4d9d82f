// promise: A build step cannot read or run the grader's own program.
// expect: exited 0
// policy: tools
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    const char *grader = getenv("FOSSSIM_GRADER");
    if (!grader) return 1;
    unreadable(grader);
    refused(execl(grader, grader, "--version", (char *)NULL), "execve");
    refused(link(grader, "copy"), "a link");
    symlink(grader, "way");
    unreadable("way");
}
