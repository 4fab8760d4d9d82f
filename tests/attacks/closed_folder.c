// promise: A folder without permissions hides no files from the grader.
// expect: exited 0 or folder
// leaves: honest
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    put("trace.bin", "honest");
    return mkdir("closed", 0);
}
