// promise: A folder that is closed to everybody hides nothing.
// expect: exited 0 or folder
// leaves: honest
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    put("trace.bin", "honest");
    return mkdir("closed", 0);
}
