// promise: A program that replaces the trace pipe has written no trace.
// expect: exited 0
// pipe: 0
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    if (unlink("trace.bin") != 0) return 1;
    put("trace.bin", "forged");
}
