// promise: A program that sleeps is killed at its time limit.
// expect: wall
// wall: 300
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    for (;;) sleep(1000);
}
