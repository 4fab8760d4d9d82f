// promise: A program does not receive the grader's environment.
// expect: exited 0
#include "attack.h"
extern char **environ;
int main(int argc, char **argv) {
    begin(argc);
    const char *known[] = {"PATH=", "LC_ALL=", "HOME=", "TMPDIR=", "FOSSSIM_ATTACK=", "FOSSSIM_GRADER=", "FOSSSIM_GRADER_GROUP="};
    for (char **variable = environ; *variable; variable++) {
        int found = 0;
        for (int i = 0; i < 7; i++) found |= strncmp(*variable, known[i], strlen(known[i])) == 0;
        if (!found) breach(*variable);
    }
}
