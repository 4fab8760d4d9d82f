// promise: The pages that a program has mapped are not to be read in /proc.
// expect: exited 0
// needs: file rules
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    unreadable("/proc/self/pagemap");
    unreadable("/proc/self/smaps");
    unreadable("/proc/self/smaps_rollup");
    unreadable("/proc/self/numa_maps");
    unreadable("/proc/self/clear_refs");
}
