// promise: The nameless files of a program whose main thread has ended count toward the folder's limit.
// expect: folder
#include "attack.h"
static void rest(void) {
    for (int i = 0; i < 8; i++) nameless(2);
    for (;;) pause();
}
int main(int argc, char **argv) {
    begin(argc);
    without_leader(rest);
}
