// promise: A build step cannot use shared memory without a file.
// expect: exited 0
// policy: tools
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    if (fork() == 0) _exit(mmap(NULL, 50 << 20, PROT_READ, MAP_SHARED | MAP_ANONYMOUS, -1, 0) != MAP_FAILED);
    int status = 0;
    wait(&status);
    if (status) breach("shared memory");
}
