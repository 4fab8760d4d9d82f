// promise: A link on the path to the trace is not followed.
// expect: exited 0
// leaves: nothing
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    mkdir("inner", 0755);
    put("inner/trace.bin", "forged");
    refused(rename("inner/trace.bin", "trace.bin/x"), "a trace inside a trace");
}
