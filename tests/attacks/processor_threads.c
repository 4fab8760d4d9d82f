// promise: The total processor time of all threads is limited.
// expect: cpu
#include "attack.h"
static void *burn(void *nothing) {
    spin();
    return nothing;
}
int main(int argc, char **argv) {
    begin(argc);
    for (int i = 0; i < 4; i++) {
        pthread_t thread;
        pthread_create(&thread, NULL, burn, NULL);
    }
    for (;;) pause();
}
