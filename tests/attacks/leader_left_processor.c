// promise: A program whose main thread has left meets its processor limit.
// expect: cpu
#include "attack.h"
static void rest(void) {
    spin();
}
int main(int argc, char **argv) {
    begin(argc);
    without_leader(rest);
}
