// promise: A program is told the size of the machine's memory, not its use and not the number of processes.
// expect: exited 0
// needs: named violations
#include "attack.h"
#include <sys/sysinfo.h>
int main(int argc, char **argv) {
    begin(argc);
    struct sysinfo about;
    if (sysinfo(&about) || !about.totalram || about.freeram != about.totalram) breach("free memory");
    if (about.procs > 1 || about.sharedram || about.bufferram || about.freeswap || about.totalswap) breach("what is in use");
    if (about.loads[0] || about.loads[1] || about.loads[2]) breach("the load");
    refused(sysinfo((void *)8), "sysinfo to nowhere");
}
