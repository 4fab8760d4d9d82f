// promise: User namespaces cannot be made.
// expect: violation unshare
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    unshare(CLONE_NEWUSER | CLONE_NEWNS);
    breach("unshare");
}
