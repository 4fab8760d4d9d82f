// promise: Namespaces cannot be joined.
// expect: violation setns
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    setns(0, 0);
    breach("setns");
}
