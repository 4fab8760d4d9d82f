// promise: A build step cannot execute a file in memory or a file without a name.
// expect: exited 0
// policy: tools
// needs: hidden files
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    refused(syscall(SYS_memfd_create, "program", 0), "memfd_create");
    int fd = open("/tmp", O_RDWR | O_TMPFILE, 0755);
    refused(fd, "a nameless file outside the folder");
    refused(open("/dev/shm/program", O_RDWR | O_CREAT, 0755), "/dev/shm");
}
