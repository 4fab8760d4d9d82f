// promise: A program that reads its own trace pipe takes only from itself.
// expect: wall
// wall: 300
// pipe: any
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    int fd = open("trace.bin", O_RDWR);
    char byte;
    for (;;) read(fd, &byte, 1);
}
