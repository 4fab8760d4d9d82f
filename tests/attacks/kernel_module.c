// promise: A program cannot load kernel modules.
// expect: violation init_module
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    forbidden(syscall(SYS_init_module, "", 0, ""), "init_module");
}
