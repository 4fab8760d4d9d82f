// promise: The machine's clock cannot be set.
// expect: violation clock_settime
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    struct timespec now;
    clock_gettime(CLOCK_REALTIME, &now);
    forbidden(clock_settime(CLOCK_REALTIME, &now), "clock_settime");
}
