// promise: The processor time of children counts toward the limit.
// expect: cpu
// policy: tools
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    if (fork() == 0) spin();
    wait(NULL);
}
