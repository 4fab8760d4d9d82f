// promise: Watches that watch each other are limited by the kernel and are harmless.
// expect: exited 0
#include "attack.h"
#include <sys/epoll.h>
int main(int argc, char **argv) {
    begin(argc);
    int inner = epoll_create1(0);
    for (int i = 0; i < 20; i++) {
        int outer = epoll_create1(0);
        struct epoll_event event = {EPOLLIN};
        if (outer < 0 || epoll_ctl(outer, EPOLL_CTL_ADD, inner, &event) != 0) return 0;
        inner = outer;
    }
}
