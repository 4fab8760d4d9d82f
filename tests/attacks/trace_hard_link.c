// promise: A trace with several hard links is not collected.
// expect: exited 0
// policy: tools
// leaves: refused
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    put("trace.bin", "forged");
    return link("trace.bin", "second");
}
