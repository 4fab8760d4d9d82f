// promise: A program cannot set the machine's clock.
// expect: violation clock_settime
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    struct timespec now;
    clock_gettime(CLOCK_REALTIME, &now);
    forbidden(clock_settime(CLOCK_REALTIME, &now), "clock_settime");
}
