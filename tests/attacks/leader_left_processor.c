// promise: The processor limit applies to a program whose main thread has ended.
// expect: cpu
#include "attack.h"
static void rest(void) {
    spin();
}
int main(int argc, char **argv) {
    begin(argc);
    without_leader(rest);
}
