// promise: A program cannot open files by handle.
// expect: violation open_by_handle_at
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    char handle[128] = {0};
    forbidden(syscall(SYS_open_by_handle_at, AT_FDCWD, handle, O_RDONLY), "open_by_handle_at");
}
