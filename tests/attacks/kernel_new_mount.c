// promise: Nothing can be mounted by the newer calls.
// expect: violation fsopen
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    forbidden(syscall(SYS_fsopen, "tmpfs", 0), "fsopen");
}
