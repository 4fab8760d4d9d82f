// promise: User namespaces cannot be made.
// expect: violation unshare
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    forbidden(unshare(CLONE_NEWUSER | CLONE_NEWNS), "unshare");
}
