// promise: The processor time of build processes whose main threads have ended counts toward the limit.
// expect: cpu
// policy: tools
#include "attack.h"
static void rest(void) {
    spin();
}
static void child(void (*rest)(void)) {
    if (fork() == 0) {
        setsid();
        without_leader(rest);
    }
}
int main(int argc, char **argv) {
    begin(argc);
    for (int i = 0; i < 4; i++) child(rest);
    for (;;) pause();
}
