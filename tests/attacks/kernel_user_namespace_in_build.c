// promise: User namespaces cannot be made in a build step either.
// expect: violation unshare
// policy: tools
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    forbidden(unshare(CLONE_NEWUSER | CLONE_NEWNS), "unshare");
}
