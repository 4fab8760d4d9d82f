// promise: A program cannot read the counters of the whole machine in /proc and /sys.
// expect: exited 0
// needs: hidden files
#include "attack.h"
int main(int argc, char **argv) {
    begin(argc);
    for (const char **path = (const char *[]){"/proc/meminfo", "/proc/loadavg", "/proc/stat", "/proc/vmstat", "/proc/uptime", "/proc/zoneinfo", "/proc/diskstats",
        "/proc/slabinfo", "/proc/buddyinfo", "/proc/interrupts", "/proc/softirqs", "/proc/schedstat", "/proc/locks", "/proc/timer_list", "/proc/key-users", "/proc/swaps",
        "/proc/pressure/memory", "/proc/pressure/io", "/proc/pressure/cpu", "/proc/sys/fs/file-nr", "/proc/sys/fs/inode-nr", "/proc/sys/fs/dentry-state",
        "/proc/sys/kernel/random/entropy_avail", "/proc/sys/kernel/ns_last_pid", "/proc/sys/kernel/pty/nr", "/proc/sysvipc/shm", "/proc/cpuinfo",
        "/sys/fs/cgroup/memory.stat", "/sys/fs/cgroup/pids.current", "/sys/kernel/mm/ksm/pages_shared", "/sys/block/vda/stat",
        "/sys/devices/system/cpu/cpu0/cpuidle/state1/usage", "/sys/devices/system/cpu/cpu0/cpufreq/scaling_cur_freq", "/sys/devices/system/node/node0/vmstat", NULL}; *path; path++)
        unreadable(*path);
    // Which processors there are, a program may ask.
    if (sysconf(_SC_NPROCESSORS_ONLN) < 1 || sysconf(_SC_NPROCESSORS_CONF) < 1) breach("no processors");
}
