// promise: A program cannot count the machine's processes by the links of /proc, or open its root folder.
// expect: exited 0
// needs: private processes
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    struct stat first, about;
    // A /proc counts every process of the machine as a link of its own; an ordinary folder counts its folders.
    for (const char **path = (const char *[]){"/proc", "/proc/self/..", "/proc/self/task/..", "/dev/fd/../..", "/proc/self/root/proc", "/proc/self/cwd/../proc", NULL}; *path; path++) {
        if (stat(*path, &about)) continue;
        if (about.st_nlink > 9) {
            printf("%s has %lu links\n", *path, (unsigned long)about.st_nlink);
            breach("a count of processes");
        }
    }
    if (stat("/proc", &first)) exit(97);
    DIR *entries = opendir("/proc");
    struct dirent *entry;
    while (entries && (entry = readdir(entries))) {
        long number = atol(entry->d_name);
        if (number && number != getpid()) breach("another process");
    }
    if (chdir("/proc/self") || chdir("..") || stat(".", &about)) exit(97);
    if (about.st_dev != first.st_dev || about.st_ino != first.st_ino) breach("another /proc");
    if (stat("/proc/1", &about) == 0 || stat("/proc/uptime", &about) == 0 || stat("/proc/sys", &about) == 0) breach("more of /proc");
    char own[40];
    snprintf(own, sizeof own, "/proc/%d/comm", getpid());
    if (access("/proc/self/maps", R_OK) || access(own, R_OK)) breach("its own entry is missing");
}
