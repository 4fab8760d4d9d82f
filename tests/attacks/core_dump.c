// promise: A crash leaves no core dump.
// expect: signalled 6
// leaves: nothing
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    struct rlimit limit;
    getrlimit(RLIMIT_CORE, &limit);
    if (limit.rlim_cur > 1) breach("core dumps are on");
    abort();
}
