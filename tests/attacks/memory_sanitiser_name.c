// promise: A name of a sanitiser does not lift the limit of address space.
// expect: could-not-start
#include "attack.h"
extern void __asan_init(void) __attribute__((weak));
int main(int argc, char **argv) {
    begin(argc);
    if (__asan_init) __asan_init();
    take_memory(1200);
    for (;;) pause();
}
