// promise: A program cannot become another user, and has no privileges.
// expect: exited 0
#include "attack.h"
#include <grp.h>
int main(int argc, char **argv) {
    begin(argc);
    if (getuid() == 0 || geteuid() == 0) breach("it runs as root");
    // An ordinary user's grader that is in root's group cannot leave it; doctor says so.
    const char *group = getenv("FOSSSIM_GRADER_GROUP");
    if (getgid() == 0 && group && atoi(group) != 0) breach("it is in root's group");
    refused(setuid(0), "setuid");
    refused(setgid(0), "setgid");
    refused(setresuid(0, 0, 0), "setresuid");
    refused(setgroups(0, NULL), "setgroups");
    FILE *status = fopen("/proc/self/status", "r");
    char line[200];
    while (status && fgets(line, sizeof line, status)) {
        unsigned long long set;
        if (sscanf(line, "CapEff: %llx", &set) == 1 && set) breach("capabilities in effect");
        if (sscanf(line, "CapPrm: %llx", &set) == 1 && set) breach("permitted capabilities");
    }
}
