// promise: A forbidden call in a thread kills the whole program.
// expect: violation bpf
#include "attack.h"
static void *attack(void *nothing) {
    forbidden(syscall(SYS_bpf, 0, nothing, 0), "bpf");
    return nothing;
}
int main(int argc, char **argv) {
    begin(argc);
    pthread_t thread;
    pthread_create(&thread, NULL, attack, NULL);
    pthread_join(thread, NULL);
    breach("bpf");
}
