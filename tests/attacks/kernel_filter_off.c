// promise: A program cannot switch off the system call filter or its other restrictions.
// expect: exited 0
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    refused(prctl(PR_SET_NO_NEW_PRIVS, 0, 0, 0, 0), "no_new_privs off");
    refused(prctl(PR_SET_SECCOMP, 0, 0, 0, 0), "seccomp off");
    refused(syscall(SYS_seccomp, 1, 8, NULL), "seccomp");
    refused(prctl(PR_CAP_AMBIENT, PR_CAP_AMBIENT_RAISE, 21, 0, 0), "ambient capability");
    refused(prctl(PR_SET_SECUREBITS, 0, 0, 0, 0), "secure bits");
    refused(syscall(444, NULL, 0, 0), "a ruleset of its own");
    refused(syscall(SYS_personality, 0x0040000), "personality");
}
