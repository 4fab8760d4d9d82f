// promise: A program cannot read the grader's own program, which holds the answers.
// expect: exited 0
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    const char *grader = getenv("FOSSSIM_GRADER");
    if (!grader) return 1;
    unreadable(grader);
    char path[100];
    snprintf(path, sizeof path, "/proc/%d/exe", getppid());
    unreadable(path);
    unreadable("/proc/1/exe");
}
