// promise: A program cannot use performance counters.
// expect: violation perf_event_open
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    char attributes[128] = {0};
    forbidden(syscall(SYS_perf_event_open, attributes, 0, -1, -1, 0), "perf_event_open");
}
