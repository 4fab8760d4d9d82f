// promise: A program cannot wake a process that waits on a futex in a library's pages by ending a thread.
// expect: exited 0
// needs: named violations
#include "attack.h"
#include <linux/futex.h>
static uint32_t *word;
static struct robust_list_head list;
static void *cleared(void *nothing) {
    usleep(30000);
    syscall(SYS_set_tid_address, word);
    return NULL;
}
static void *robust(void *nothing) {
    usleep(30000);
    list.list.next = &list.list;
    list.list_op_pending = (struct robust_list *)word;
    syscall(SYS_set_robust_list, &list, sizeof list);
    syscall(SYS_exit, 0);
    return NULL;
}
int main(int argc, char **argv) {
    begin(argc);
    int fd = open(argv[0], O_RDONLY);
    char *page = mmap(NULL, 4096, PROT_READ, MAP_SHARED, fd, 0);
    if (page == MAP_FAILED) exit(97);
    // A word of zeros: the end of the file's mark.
    word = (uint32_t *)(page + 8);
    for (int i = 0; i < 2; i++) {
        pthread_t thread;
        if (pthread_create(&thread, NULL, i ? robust : cleared, NULL)) exit(97);
        struct timespec limit = {0, 200000000};
        if (!syscall(SYS_futex, word, 0, *word, &limit, NULL, 0)) breach("the end of a thread is seen");
        usleep(60000);
    }
    _exit(0);
}
