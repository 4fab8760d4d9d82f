// promise: A program inherits no descriptor of the grader.
// expect: exited 0
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    for (int fd = 3; fd < 4096; fd++) refused(fcntl(fd, F_GETFD), "an inherited descriptor");
    char byte;
    if (read(0, &byte, 1) != 0) breach("standard input is not empty");
    if (isatty(0) || isatty(1) || isatty(2)) breach("a terminal");
    refused(open("/dev/tty", O_RDWR), "the controlling terminal");
}
