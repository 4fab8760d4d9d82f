// promise: To read what a program may read of the system changes no time that another run could see.
// expect: exited 0
#include "attack.h"
static char path[1000][300];
int main(int argc, char **argv) {
    begin(argc);
    FILE *maps = fopen("/proc/self/maps", "r");
    char line[400];
    int count = 0;
    while (maps && count < 1000 && fgets(line, sizeof line, maps)) {
        char *start = strstr(line, " /");
        if (!start || (strncmp(start, " /usr", 5) && strncmp(start, " /lib", 5))) continue;
        start[strcspn(start, "\n")] = 0;
        snprintf(path[count++], sizeof path[0], "%s", start + 1);
    }
    const char *others[] = {"/etc/ld.so.cache", "/etc/localtime", "/usr/lib/x86_64-linux-gnu/gconv/gconv-modules.cache", "/usr/lib/x86_64-linux-gnu/gconv/UTF-16.so",
        "/usr/lib/x86_64-linux-gnu/libgcc_s.so.1", "/usr/lib/locale/C.utf8/LC_CTYPE", "/usr/lib/locale/C.utf8/LC_MESSAGES/SYS_LC_MESSAGES", NULL};
    for (const char **other = others; *other; other++) snprintf(path[count++], sizeof path[0], "%s", *other);
    for (int i = 0; i < count; i++) {
        struct stat before, after;
        int fd = open(path[i], O_RDONLY);
        if (fd < 0 || fstat(fd, &before)) continue;
        while (read(fd, block, sizeof block) > 0);
        if (fstat(fd, &after) || before.st_atim.tv_sec != after.st_atim.tv_sec || before.st_atim.tv_nsec != after.st_atim.tv_nsec) breach(path[i]);
        close(fd);
    }
    if (count < 6) exit(97);
}
