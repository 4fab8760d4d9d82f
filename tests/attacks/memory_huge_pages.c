// promise: A program cannot use huge pages, which no counter shows.
// expect: exited 0
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    int flags = MAP_PRIVATE | MAP_ANONYMOUS | MAP_HUGETLB;
    if (mmap(NULL, 2 << 20, PROT_READ | PROT_WRITE, flags, -1, 0) != MAP_FAILED) breach("huge pages");
    if (errno != EPERM) breach("huge pages are refused by their number only");
}
