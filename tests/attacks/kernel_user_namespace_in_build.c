// promise: A build step cannot create user namespaces.
// expect: violation unshare
// policy: tools
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    forbidden(unshare(CLONE_NEWUSER | CLONE_NEWNS), "unshare");
}
