// promise: Descriptor commands outside the filter's list are rejected.
// expect: exited 0
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    int fd = open("/dev/null", O_RDWR);
    for (int command = 0; command < 1100; command++) {
        long answer = fcntl(fd, command, 0);
        int harmless = command <= 4 || command == 9 || command == F_DUPFD_CLOEXEC;
        if (answer != -1 && !harmless && command != 1034) breach("a command");
    }
}
