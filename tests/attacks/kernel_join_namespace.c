// promise: Namespaces cannot be joined.
// expect: violation setns
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    forbidden(setns(0, 0), "setns");
}
