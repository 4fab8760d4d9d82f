// promise: A program cannot change, move or remove references.
// expect: exited 0
// needs: hidden files
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    char secret[PATH_MAX];
    snprintf(secret, sizeof secret, "%s", in(argv[1], "reference.bin"));
    refused(open(secret, O_WRONLY), "open for writing");
    refused(open(secret, O_WRONLY | O_TRUNC), "open to truncate");
    refused(open(secret, O_RDWR | O_APPEND), "open to append");
    refused(truncate(secret, 0), "truncate");
    refused(unlink(secret), "unlink");
    refused(rename(secret, "mine"), "rename to here");
    put("forged", "forged");
    refused(rename("forged", secret), "rename from here");
    refused(link(secret, "mine"), "link");
    refused(link("forged", in(argv[1], "new")), "link from here");
    refused(mkdir(in(argv[1], "new"), 0755), "mkdir");
    refused(rmdir(in(argv[1], "empty")), "rmdir");
    refused(open(in(argv[1], "new"), O_WRONLY | O_CREAT, 0644), "create");
    refused(symlink("forged", in(argv[1], "new")), "symlink");
}
