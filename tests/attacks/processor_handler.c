// promise: A program gains no processor time by ignoring the signals of limits.
// expect: cpu
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    for (int signal_number = 1; signal_number < 32; signal_number++) signal(signal_number, SIG_IGN);
    spin();
}
