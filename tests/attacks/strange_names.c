// promise: Unusual file names are harmless.
// expect: exited 0
// leaves: honest
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    char longest[256];
    memset(longest, 'n', 255);
    longest[255] = 0;
    const char *names[] = {"new\nline", "\xff\xfe", "-rf", " ", "\x1b[31mred", "=cmd|calc!A0", "<b>", longest};
    for (int i = 0; i < 8; i++) put(names[i], "x");
    put("trace.bin", "honest");
}
