// promise: A folder with the trace's name is not collected.
// expect: exited 0
// leaves: refused
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    return mkdir("trace.bin", 0755);
}
