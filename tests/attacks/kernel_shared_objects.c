// promise: A program cannot leave data in the kernel's shared memory, semaphores and queues.
// expect: exited 0
#include "attack.h"
#include <mqueue.h>
#include <sys/msg.h>
#include <sys/sem.h>
#include <sys/shm.h>
int main(int argc, char **argv) {
    begin(argc);
    refused(shmget(IPC_PRIVATE, 4096, IPC_CREAT | 0600), "shmget");
    refused(semget(IPC_PRIVATE, 1, IPC_CREAT | 0600), "semget");
    refused(msgget(IPC_PRIVATE, IPC_CREAT | 0600), "msgget");
    refused(syscall(SYS_mq_open, "queue", O_RDWR | O_CREAT, 0600, NULL), "mq_open");
}
