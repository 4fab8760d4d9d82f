// promise: A program cannot read or list other submissions.
// expect: exited 0
// needs: hidden files
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    unreadable(in(argv[4], "answer.txt"));
    if (opendir(argv[4])) breach("the neighbor's folder can be listed");
    refused(open(in(argv[4], "answer.txt"), O_WRONLY), "the neighbor's file can be written");
    refused(open(in(argv[4], "planted"), O_WRONLY | O_CREAT, 0644), "files can be planted");
}
