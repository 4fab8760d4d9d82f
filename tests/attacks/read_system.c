// promise: A program cannot read the machine's settings, home folders and logs.
// expect: exited 0
// needs: file rules
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    const char *files[] = {"/etc/passwd", "/etc/hostname", "/etc/hosts", "/etc/fstab", "/proc/1/cmdline", "/proc/version"};
    const char *folders[] = {"/", "/root", "/home", "/etc", "/tmp", "/var", "/usr", "/usr/bin", "/run", "/proc", "/sys"};
    for (int i = 0; i < 6; i++) unreadable(files[i]);
    for (int i = 0; i < 11; i++)
        if (opendir(folders[i])) breach(folders[i]);
}
