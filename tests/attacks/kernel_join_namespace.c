// promise: A program cannot join namespaces.
// expect: violation setns
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    forbidden(setns(0, 0), "setns");
}
