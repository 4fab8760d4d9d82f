// promise: A submission cannot start other processes.
// expect: violation
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    for (;;) fork();
}
