// promise: A program cannot create a pipe, device or socket with the trace's name.
// expect: exited 0
// leaves: nothing
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    refused(mkfifo("trace.bin", 0666), "mkfifo");
    refused(mknod("trace.bin", S_IFCHR | 0666, 0x0105), "mknod of a device");
    refused(mknod("trace.bin", S_IFSOCK | 0666, 0), "mknod of a socket");
    refused(mknod("trace.bin", S_IFREG | 0666, 0), "mknod of a file");
}
