// promise: Files in memory do not exist for a program.
// expect: exited 0
// needs: hidden files
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    refused(syscall(SYS_memfd_create, "hoard", 0), "memfd_create");
    refused(open("/dev/shm/hoard", O_RDWR | O_CREAT, 0600), "/dev/shm");
    refused(open("/run/hoard", O_RDWR | O_CREAT, 0600), "/run");
    refused(open(".", O_RDWR | O_TMPFILE, 0600) < 0 ? -1 : open("/tmp", O_RDWR | O_TMPFILE, 0600), "O_TMPFILE in /tmp");
}
