// promise: A build step cannot ask either.
// expect: exited 0
// policy: tools
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    int fd = open("/bin/sh", O_RDONLY);
    unsigned char pages[4];
    char *part = mmap(NULL, 4096, PROT_READ, MAP_SHARED, fd, 0);
    refused(mincore(part, 4096, pages), "mincore");
    errno = posix_fadvise(fd, 0, 0, POSIX_FADV_DONTNEED);
    if (!errno) breach("posix_fadvise");
}
