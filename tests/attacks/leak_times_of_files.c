// promise: A program that reads a file of the system changes no time that another run could read.
// expect: exited 0
// needs: private mounts
#include "attack.h"
static int seen;
// The time at which somebody read the entry last.
static struct timespec last_read(const char *path) {
    struct stat about;
    if (lstat(path, &about)) return (struct timespec){0, 0};
    return about.st_atim;
}
static void walk(const char *folder) {
    DIR *entries = opendir(folder);
    struct dirent *entry;
    while (entries && seen < 3000 && (entry = readdir(entries))) {
        if (!strcmp(entry->d_name, ".") || !strcmp(entry->d_name, "..")) continue;
        char path[PATH_MAX], target[PATH_MAX];
        snprintf(path, sizeof path, "%s/%s", folder, entry->d_name);
        struct timespec before = last_read(path);
        int fd = open(path, O_RDONLY | O_NONBLOCK | O_NOFOLLOW);
        if (fd >= 0) {
            if (read(fd, block, 1)) {}
            close(fd);
        }
        if (readlink(path, target, sizeof target)) {}
        if (entry->d_type == DT_DIR && strlen(path) < 60) walk(path);
        struct timespec after = last_read(path);
        if (before.tv_sec != after.tv_sec || before.tv_nsec != after.tv_nsec) breach(path);
        seen++;
    }
    if (entries) closedir(entries);
}
int main(int argc, char **argv) {
    begin(argc);
    for (const char **folder = (const char *[]){"/lib64", "/usr/lib/locale", "/usr/lib/x86_64-linux-gnu/gconv", "/usr/lib", NULL}; *folder; folder++) walk(*folder);
    if (seen < 6) exit(97);
}
