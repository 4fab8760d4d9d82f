// promise: A program cannot signal its supervisor or the grader.
// expect: exited 0
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    int victims[] = {getppid(), atoi(argv[2]), 1};
    for (int i = 0; i < 3; i++) {
        refused(kill(victims[i], SIGKILL), "kill");
        refused(kill(-victims[i], SIGKILL), "kill of a group");
        refused(syscall(SYS_tkill, victims[i], SIGKILL), "tkill");
        refused(syscall(SYS_tgkill, victims[i], victims[i], SIGKILL), "tgkill");
        siginfo_t information = {.si_code = SI_QUEUE};
        refused(syscall(SYS_rt_sigqueueinfo, victims[i], SIGKILL, &information), "rt_sigqueueinfo");
    }
}
