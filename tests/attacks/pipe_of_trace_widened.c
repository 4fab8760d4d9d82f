// promise: The trace pipe cannot be made larger or smaller.
// expect: exited 0
// pipe: 6
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    int fd = open("trace.bin", O_WRONLY);
    if (fd < 0) return 1;
    refused(fcntl(fd, F_SETPIPE_SZ, 1 << 20), "F_SETPIPE_SZ");
    refused(fcntl(fd, F_SETPIPE_SZ, 4096), "F_SETPIPE_SZ");
    if (write(fd, "honest", 6) != 6) return 2;
}
