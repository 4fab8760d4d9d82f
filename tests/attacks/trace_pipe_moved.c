// promise: A program that moves the trace pipe away harms only itself.
// expect: exited 0
// pipe: 6
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    put(rename("trace.bin", "elsewhere") == 0 ? "elsewhere" : "trace.bin", "honest");
    mkdir("trace.bin", 0755);
}
