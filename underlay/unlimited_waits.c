/* Copyright 2026 The Husky Playpen Lab authors
 * SPDX-License-Identifier: Apache-2.0
 *
 * What the wheels call in place of pthread_cond_timedwait; see mended_calls.py.
 *
 * No header is included but TinyCC's own: a user need not have those of libc.
 */
#include <stddef.h>

struct timespec {
    long tv_sec;
    long tv_nsec;
};

typedef int timed_wait(void *condition, void *mutex, const struct timespec *until);

void *dlvsym(void *handle, const char *symbol, const char *version);

static timed_wait *pthread_cond_timedwait;

/* By its version: without one the linker finds that of GLIBC_2.2.5, of other condition variables. */
__attribute__((constructor)) static void find_pthread_cond_timedwait(void)
{
    pthread_cond_timedwait = dlvsym(NULL, "pthread_cond_timedwait", "GLIBC_2.3.2");
}

static const struct timespec in_the_year_2242 = {1L << 33, 0};

/* Waits as pthread_cond_timedwait does; without a limit where its time has overflowed. */
int unlimited_cond_timedwait(void *condition, void *mutex, const struct timespec *until)
{
    if (until->tv_sec < 0 || until->tv_nsec < 0)
        until = &in_the_year_2242;
    return pthread_cond_timedwait(condition, mutex, until);
}
