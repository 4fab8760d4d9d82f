// promise: A build step cannot make pages of files leave memory, age, merge or move.
// expect: exited 0
// policy: tools
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    int fd = open("/bin/sh", O_RDONLY);
    char *file = mmap(NULL, 4096, PROT_READ, MAP_PRIVATE, fd, 0);
    if (file[0] != 0x7f) exit(97);
    for (int *advice = (int[]){12, 20, 21, 25, 0}; *advice; advice++) refused(madvise(file, 4096, *advice), "advice about a file");
}
