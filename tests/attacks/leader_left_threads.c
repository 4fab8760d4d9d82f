// promise: A program whose main thread has ended cannot have more threads than its limit.
// expect: processes
#include "attack.h"
static void *wait_for_ever(void *nothing) {
    for (;;) pause();
}
static void rest(void) {
    pthread_attr_t small;
    pthread_attr_init(&small);
    pthread_attr_setstacksize(&small, 65536);
    for (int i = 0; i < 10000; i++) {
        pthread_t thread;
        if (pthread_create(&thread, &small, wait_for_ever, NULL)) break;
    }
    for (;;) pause();
}
int main(int argc, char **argv) {
    begin(argc);
    without_leader(rest);
}
