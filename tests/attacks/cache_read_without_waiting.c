// promise: Nor find out by a read that does not wait.
// expect: exited 0
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    int fd = open("/proc/self/exe", O_RDONLY);
    char bytes[16];
    struct iovec part = {bytes, sizeof bytes};
    refused(preadv2(fd, &part, 1, 0, 8 /* RWF_NOWAIT */), "RWF_NOWAIT");
    put("own", "x");
    int own = open("own", O_RDWR);
    refused(pwritev2(own, &part, 1, 0, 8), "RWF_NOWAIT");
    if (preadv2(fd, &part, 1, 0, 0) != sizeof bytes) return 1;
}
