// promise: Files of the system that nobody has read for long, whose pages would be a store, cannot be read.
// expect: exited 0
// needs: hidden files
#include "attack.h"
#include <glob.h>
// Folders may be there, as the place of a file that may be read.
static void cold(const char *path) {
    struct stat about;
    // Its own libraries it may read.
    if (strstr(path, "/libc.so.6")) return;
    if (!stat(path, &about) && S_ISREG(about.st_mode)) unreadable(path);
}
int main(int argc, char **argv) {
    begin(argc);
    const char *patterns[] = {"/usr/share/zoneinfo/*", "/usr/lib/gcc/*/*/lto1", "/usr/lib/gcc/*/*/cc1", "/usr/libexec/gcc/*/*/cc1", "/usr/lib/*/libasan.so*",
        "/usr/lib/*/libgomp.so*", "/usr/lib/*/libLLVM*", "/usr/lib/*/libstdc++.so*", "/usr/lib/*/lib[a-f]*.so*", "/usr/lib/*/gconv/E*.so", "/usr/lib/*.so*",
        "/lib/*/libm.so.6", "/lib/*/libpthread*", "/usr/lib64/lib[a-f]*.so*", "/usr/local/lib/*", NULL};
    const char *names[] = {"/usr/share/zoneinfo/Europe/Berlin", "/usr/share/zoneinfo/tzdata.zi", "/usr/lib/x86_64-linux-gnu/libm.so.6",
        "/usr/lib/x86_64-linux-gnu/libstdc++.so.6", "/usr/lib/gcc/x86_64-linux-gnu/12/cc1", "/usr/lib/os-release", "/usr/bin/env", "/bin/sh", NULL};
    for (const char **name = names; *name; name++) cold(*name);
    for (const char **pattern = patterns; *pattern; pattern++) {
        glob_t found;
        if (glob(*pattern, 0, NULL, &found)) continue;
        for (size_t i = 0; i < found.gl_pathc; i++) cold(found.gl_pathv[i]);
        globfree(&found);
    }
}
