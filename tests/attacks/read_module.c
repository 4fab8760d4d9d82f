// promise: A program cannot read the grader's module for Python, wherever pip has put it.
// expect: exited 0
#include "attack.h"
#include <glob.h>
// Reads every file of the pattern, and every file in its folders.
static void try(const char *pattern) {
    glob_t found;
    if (glob(pattern, 0, NULL, &found)) return;
    for (size_t i = 0; i < found.gl_pathc; i++) {
        struct stat about;
        if (stat(found.gl_pathv[i], &about)) continue;
        if (!S_ISDIR(about.st_mode)) unreadable(found.gl_pathv[i]);
        else if (strlen(found.gl_pathv[i]) < 200) try(in(found.gl_pathv[i], "*"));
    }
    globfree(&found);
}
int main(int argc, char **argv) {
    begin(argc);
    try("/usr/lib/py*/*-packages/fosssim*");
    try("/usr/lib64/py*/*-packages/fosssim*");
    try("/usr/local/lib/py*/*-packages/fosssim*");
    try("/usr/local/lib64/py*/*-packages/fosssim*");
}
