// promise: A program cannot create user namespaces.
// expect: violation unshare
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    forbidden(unshare(CLONE_NEWUSER | CLONE_NEWNS), "unshare");
}
