// promise: A program is judged by the regular file that it leaves under the trace's name.
// expect: exited 0
// leaves: second
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    put("trace.bin", "first");
    put("other", "second");
    return rename("other", "trace.bin");
}
