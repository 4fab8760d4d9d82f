// promise: System calls outside the filter's list do not exist for a program.
// expect: exited 0
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    for (long number = 470; number < 1100; number++) {
        refused(syscall(number, 0, 0, 0, 0, 0, 0), "an unknown call");
        if (errno != ENOSYS) breach("an unknown call exists");
    }
}
