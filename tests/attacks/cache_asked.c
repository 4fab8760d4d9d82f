// promise: A program cannot ask which pages of a file are in memory.
// expect: exited 0
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    int fd = open("/proc/self/exe", O_RDONLY);
    unsigned char pages[4];
    char *part = mmap(NULL, 4096, PROT_READ, MAP_SHARED, fd, 0);
    refused(mincore(part, 4096, pages), "mincore");
    struct { uint64_t from, length; } range = {0, 4096};
    uint64_t counts[5];
    refused(syscall(451, fd, &range, counts, 0), "cachestat");
}
