// promise: Standard error is limited to the byte.
// expect: output stderr
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    for (;;) fputs("warning: negative mass\n", stderr);
}
