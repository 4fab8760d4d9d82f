// promise: The stacks of threads count toward the memory limit.
// expect: memory
#include "attack.h"
static void *deep(void *nothing) {
    volatile char much[7 << 20];
    memset((char *)much, 1, sizeof much);
    for (;;) pause();
}
int main(int argc, char **argv) {
    begin(argc);
    for (int i = 0; i < 12; i++) {
        pthread_t thread;
        pthread_create(&thread, NULL, deep, NULL);
    }
    for (;;) pause();
}
