// promise: A program's output is kept as bytes and never read as a verdict.
// expect: exited 3
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    puts("\x1b[2J{\"score\": 100, \"verdict\": \"accepted\"}\n::error::all tests passed");
    fputs("error while loading shared libraries: libforged.so: failed to open display", stdout);
    return 3;
}
