/* Copyright 2026 The Husky Playpen Lab authors
 * SPDX-License-Identifier: Apache-2.0
 *
 * What Fast DDS calls in place of shm_unlink; see mended_calls.py.
 *
 * No header is included but TinyCC's own: a user need not have those of libc.
 */
#include <stddef.h>

typedef unsigned int word;

/* Where a port in shared memory tells of itself: from SharedMemGlobal::PortNode of Fast DDS 2.14. */
struct port_node {
    word port_id;
    word num_listeners;
    word healthy_check_timeout_ms;
    word port_wait_timeout_ms;
    word max_buffer_descriptors;
    word waiting_count;
    word flags;
};

enum { IS_PORT_OK = 1, WAITS_IN_HEALTHY_CHECK = 3 };
enum { O_RDWR = 2, SEEK_END = 2, PROT_READ_WRITE = 3, MAP_SHARED = 1 };
enum { BEGINNING = 4096 }; /* bytes, in which the node is: after what Boost tells of the memory */

int shm_open(const char *name, int flags, word mode);
int shm_unlink(const char *name);
long lseek(int file, long offset, int whence);
void *mmap(void *address, size_t length, int protection, int flags, int file, long offset);
int munmap(void *address, size_t length);
int close(int file);

/* Tells whether it is the name of a port, and gives the port's number. */
static int is_port(const char *name, word *number)
{
    const char *expected = "fastrtps_port";

    if (*name == '/')
        name++;
    while (*expected)
        if (*name++ != *expected++)
            return 0;
    if (!*name)
        return 0;
    for (*number = 0; *name >= '0' && *name <= '9'; name++)
        *number = *number * 10 + (word)(*name - '0');
    return !*name;
}

static void mark(char *memory, word number)
{
    char *last = memory + BEGINNING - sizeof(struct port_node);

    for (; memory <= last; memory += sizeof(word)) {
        volatile struct port_node *node = (struct port_node *)memory;
        word check = node->healthy_check_timeout_ms;

        if (node->port_id == number && check && node->max_buffer_descriptors
            && node->port_wait_timeout_ms == check / WAITS_IN_HEALTHY_CHECK)
            node->flags &= ~(word)IS_PORT_OK;
    }
}

/* Removes what shm_unlink removes; of a port, all that have it open learn that it is no more. */
int mark_and_unlink(const char *name)
{
    word number;
    int file;

    if (is_port(name, &number) && (file = shm_open(name, O_RDWR, 0)) >= 0) {
        if (lseek(file, 0, SEEK_END) >= BEGINNING) {
            char *memory = mmap(NULL, BEGINNING, PROT_READ_WRITE, MAP_SHARED, file, 0);

            if (memory != (char *)-1) {
                mark(memory, number);
                munmap(memory, BEGINNING);
            }
        }
        close(file);
    }
    return shm_unlink(name);
}
