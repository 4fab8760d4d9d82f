// promise: A program cannot mount file systems with the newer calls (fsopen, move_mount).
// expect: violation fsopen
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    forbidden(syscall(SYS_fsopen, "tmpfs", 0), "fsopen");
}
