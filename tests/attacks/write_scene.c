// promise: A program can read the scene, but not rewrite it.
// expect: exited 0
// needs: hidden files
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    if (open(argv[3], O_RDONLY) < 0) breach("the scene cannot be read");
    refused(open(argv[3], O_WRONLY), "open for writing");
    refused(unlink(argv[3]), "unlink");
    put("forged.xml", "<scene/>");
    refused(rename("forged.xml", argv[3]), "rename");
    char *map = mmap(NULL, 100, PROT_READ | PROT_WRITE, MAP_SHARED, open(argv[3], O_RDONLY), 0);
    if (map != MAP_FAILED) breach("mapped for writing");
}
