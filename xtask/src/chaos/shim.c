/* Stands between the command and the system, loaded by LD_PRELOAD: a disk that has room for CHAOS_DISK bytes, and a clock that
   jumps back and forth by years, by the chance that CHAOS_CLOCK begins. */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <sys/types.h>
#include <sys/uio.h>
#include <time.h>
#include <unistd.h>

static _Atomic long long room = -1;
static _Atomic unsigned long long chance;
static int jumps;

__attribute__((constructor)) static void begin(void) {
    const char *disk = getenv("CHAOS_DISK"), *clock = getenv("CHAOS_CLOCK");
    if (disk) room = atoll(disk);
    if (clock) {
        chance = strtoull(clock, NULL, 10);
        jumps = 1;
    }
}

/* How many of so many bytes a file may take. */
static long long granted(int fd, size_t wanted) {
    struct stat about;
    if (room < 0 || fstat(fd, &about) != 0 || !S_ISREG(about.st_mode)) return (long long)wanted;
    long long before = atomic_load(&room), taken;
    do taken = before < (long long)wanted ? before : (long long)wanted;
    while (!atomic_compare_exchange_weak(&room, &before, before - taken));
    return taken;
}

ssize_t write(int fd, const void *bytes, size_t count) {
    static ssize_t (*real)(int, const void *, size_t);
    if (!real) real = dlsym(RTLD_NEXT, "write");
    long long may = granted(fd, count);
    if (may == 0 && count > 0) {
        errno = ENOSPC;
        return -1;
    }
    return real(fd, bytes, (size_t)may);
}

ssize_t writev(int fd, const struct iovec *parts, int count) {
    for (int part = 0; part < count; part++)
        if (parts[part].iov_len > 0) return write(fd, parts[part].iov_base, parts[part].iov_len);
    return 0;
}

int clock_gettime(clockid_t which, struct timespec *now) {
    static int (*real)(clockid_t, struct timespec *);
    if (!real) real = dlsym(RTLD_NEXT, "clock_gettime");
    int done = real(which, now);
    if (done == 0 && jumps && which == CLOCK_REALTIME) {
        unsigned long long drawn = atomic_fetch_add(&chance, 0x9e3779b97f4a7c15ULL);
        drawn = (drawn ^ (drawn >> 30)) * 0xbf58476d1ce4e5b9ULL;
        drawn ^= drawn >> 27;
        /* Twenty years, ahead or back. */
        now->tv_sec += (long long)(drawn % 1262304000ULL) - 631152000LL;
    }
    return done;
}
