// promise: A thread cannot execute a program.
// expect: violation execve
#include "attack.h"
static void *execute(void *nothing) {
    execl("/bin/sh", "sh", (char *)NULL);
    return NULL;
}
int main(int argc, char **argv) {
    begin(argc);
    pthread_t thread;
    pthread_create(&thread, NULL, execute, NULL);
    pthread_join(thread, NULL);
    breach("execve");
}
