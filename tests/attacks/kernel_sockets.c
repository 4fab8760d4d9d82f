// promise: A program has no network and no socket of any other kind.
// expect: exited 0
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    // Unix, IPv4, IPv6, netlink, packet, kernel crypto, virtual machines, Bluetooth
    int families[] = {1, 2, 10, 16, 17, 38, 40, 31};
    for (int i = 0; i < 8; i++) {
        refused(socket(families[i], SOCK_STREAM, 0), "a stream socket");
        refused(socket(families[i], SOCK_DGRAM, 0), "a datagram socket");
        refused(socket(families[i], SOCK_RAW, 255), "a raw socket");
    }
    int pair[2];
    refused(socketpair(AF_UNIX, SOCK_STREAM, 0, pair), "socketpair");
}
