// promise: A program cannot make its own pages or those of files leave memory, age, merge or move.
// expect: exited 0
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    int fd = open(argv[0], O_RDONLY);
    char *file = mmap(NULL, 4096, PROT_READ, MAP_PRIVATE, fd, 0);
    char *own = mmap(NULL, 4 << 20, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    memset(own, 1, 4 << 20);
    // Mergeable and not, poison, offline, cold, page out, collapse, and what is not known yet.
    for (int *advice = (int[]){12, 100, 101, 20, 21, 25, 24, 26, 5, 1000, 0}; *advice; advice++) {
        refused(madvise(file, 4096, *advice), "advice about a file");
        refused(madvise(own, 4 << 20, *advice), "advice about memory");
    }
    struct iovec range = {own, 4096};
    refused(syscall(440, -1, &range, 1, 21, 0), "process_madvise");
    if (madvise(own, 4096, MADV_DONTNEED) || own[0]) breach("memory is not given back");
}
