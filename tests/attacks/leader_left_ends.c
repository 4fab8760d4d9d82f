// promise: A program whose main thread has ended ends with the code of its last thread.
// expect: exited 0
// leaves: honest
#include "attack.h"
static void rest(void) {
    put("trace.bin", "honest");
    exit(0);
}
int main(int argc, char **argv) {
    begin(argc);
    without_leader(rest);
}
