// promise: A program cannot take leases on files or watch folders, which would delay or observe other programs.
// expect: exited 0
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    int fd = open("/dev/null", O_RDONLY), folder = open(".", O_RDONLY), own;
    put("own", "x");
    own = open("own", O_RDONLY);
    refused(fcntl(fd, F_SETLEASE, F_RDLCK), "a lease");
    refused(fcntl(own, F_SETLEASE, F_WRLCK), "a lease of its own file");
    refused(fcntl(folder, F_NOTIFY, DN_CREATE | DN_MULTISHOT), "F_NOTIFY");
}
