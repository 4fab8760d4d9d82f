// promise: A program cannot handle page faults itself (userfaultfd).
// expect: violation userfaultfd
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    forbidden(syscall(SYS_userfaultfd, 0), "userfaultfd");
}
