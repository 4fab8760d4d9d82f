// promise: A program cannot write to devices or change the kernel's settings.
// expect: exited 0
// needs: file rules
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    const char *files[] = {"/dev/mem", "/dev/kmem", "/dev/port", "/dev/kmsg", "/dev/sda", "/dev/vda", "/dev/tty0",
                           "/dev/ptmx", "/dev/fuse", "/dev/kvm", "/dev/net/tun", "/dev/loop-control", "/proc/sysrq-trigger",
                           "/proc/sys/kernel/core_pattern", "/proc/self/mem", "/proc/self/setgroups"};
    for (int i = 0; i < 16; i++) refused(open(files[i], O_WRONLY), files[i]);
    refused(open("/dev/fuse", O_RDWR), "/dev/fuse");
    refused(open("/dev/kvm", O_RDWR), "/dev/kvm");
}
