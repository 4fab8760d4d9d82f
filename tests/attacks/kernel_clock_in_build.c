// promise: A build step cannot set the machine's clock.
// expect: violation adjtimex
// policy: tools
#include "attack.h"
#include <sys/timex.h>
int main(int argc, char **argv) {
    begin(argc);
    struct timex change = {0};
    forbidden(syscall(SYS_adjtimex, &change), "adjtimex");
}
