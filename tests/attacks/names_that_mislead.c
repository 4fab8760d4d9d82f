// promise: Very long names, and names with direction marks or zero-width blanks, are harmless.
// expect: exited 0
// leaves: honest
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    const char *names[] = {"\u202Enib.ecart", "\u061Ctrace", "trace\u200B.bin", "\u2066x\u2069", "\uFEFFtrace.bin", "\r", "\t", "trace.bin\n", "..."};
    for (int i = 0; i < 9; i++) put(names[i], "forged");
    put("trace.bin", "honest");
}
