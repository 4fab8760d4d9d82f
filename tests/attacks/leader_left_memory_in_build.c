// promise: The memory of build processes whose main threads have ended counts toward the limit.
// expect: memory
// policy: tools
#include "attack.h"
static void rest(void) {
    take_memory(24);
    for (;;) pause();
}
static void child(void (*rest)(void)) {
    if (fork() == 0) {
        setsid();
        without_leader(rest);
    }
}
int main(int argc, char **argv) {
    begin(argc);
    for (int i = 0; i < 6; i++) child(rest);
    for (;;) pause();
}
