// promise: A program cannot send signals that carry a value to other programs.
// expect: exited 0
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    siginfo_t info = {.si_signo = SIGKILL, .si_code = SI_QUEUE};
    int victim = atoi(argv[2]);
    refused(syscall(SYS_rt_sigqueueinfo, victim, SIGKILL, &info), "rt_sigqueueinfo");
    refused(syscall(SYS_rt_tgsigqueueinfo, victim, victim, SIGKILL, &info), "rt_tgsigqueueinfo");
    refused(syscall(SYS_tkill, victim, SIGKILL), "tkill");
    refused(syscall(SYS_tgkill, victim, victim, SIGKILL), "tgkill");
    refused(syscall(SYS_tkill, getppid(), SIGSTOP), "tkill of the supervisor");
}
