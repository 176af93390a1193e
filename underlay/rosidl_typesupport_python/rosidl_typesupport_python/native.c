/* Copyright 2026 The Husky Playpen Lab authors
 * SPDX-License-Identifier: Apache-2.0
 *
 * What ROS calls of a type by pointers. It is compiled once, at set-up, by TinyCC.
 *
 * Only type support looks into a message: for rcl and rmw it is an address. Here a message is its
 * bytes in CDR, so that these functions serve every type; Python makes the bytes and reads them.
 *
 * Fast DDS calls serialize, deserialize and serialized_size with its locks held, and rclpy may
 * wait for these with the interpreter's: whatever needs the interpreter there ends in a deadlock.
 * So it is needed by convert_from_py and convert_to_py alone, which rclpy calls. Bytes that are not
 * those of the type are dropped there, as compiled types drop them: the receiver goes on.
 *
 * No header is included but TinyCC's own: a user need not have those of Python, ROS or libc.
 */
#include <stdbool.h>
#include <stddef.h>

typedef struct object PyObject;
PyObject *PyObject_CallFunctionObjArgs(PyObject *callable, ...);
PyObject *PyBytes_FromStringAndSize(const char *data, ptrdiff_t size);
int PyBytes_AsStringAndSize(PyObject *bytes, char **data, ptrdiff_t *size);
PyObject *PyErr_NoMemory(void);
void Py_DecRef(PyObject *object);

void *calloc(size_t count, size_t size);
void *realloc(void *data, size_t size);
void free(void *data);
void *memcpy(void *to, const void *from, size_t size);
int strcmp(const char *one, const char *other);
size_t strlen(const char *text);
ptrdiff_t write(int file, const void *data, size_t size);

/* ---- Fast CDR 2.2: Cdr.h, FastBuffer.h; native.py checks that the places are right ----------- */

struct fast_buffer {
    const void *virtual_functions;
    char *data;
    size_t size;
};

struct cdr {
    void *callbacks[14]; /* seven pointers to members */
    struct fast_buffer *buffer;
};

/* Its functions; native.py sets them, so that its library need not be found by the linker. */
struct {
    bool (*jump)(struct cdr *cdr, size_t size);
    char *(*position)(struct cdr *cdr);
} fast_cdr;

/* ---- the shape of a type, as far as it says where a message ends ------------------------------- */

struct shape { /* a field; a field of size 0 stands behind the last */
    unsigned size;             /* of each item, which is aligned to it */
    bool has_length;           /* a uint32 before the items says how many there are */
    size_t count;              /* of items; the most that are allowed, where that says how many */
    const struct shape *items; /* of what each consists, where that is no number */
};

static size_t aligned(size_t place, size_t size)
{
    return (place + size - 1) / size * size;
}

/* Returns where a value ends that begins at a place; more than the size if it is no such value. */
static size_t end_of(const struct shape *field, const char *data, size_t size, size_t place)
{
    for (; field->size && place <= size; field++) {
        size_t count = field->count;

        if (field->has_length) {
            unsigned length;

            place = aligned(place, sizeof(length)) + sizeof(length);
            if (place > size)
                return place;
            memcpy(&length, data + place - sizeof(length), sizeof(length));
            if (length > count)
                return size + 1;
            count = length;
        }
        if (!field->items && count)
            place = aligned(place, field->size) + count * field->size;
        for (; field->items && count && place <= size; count--) /* each has a byte at least */
            place = end_of(field->items, data, size, place);
    }
    return place;
}

/* ---- a message -------------------------------------------------------------------------------- */

struct codec {
    PyObject *encode; /* message -> bytes */
    PyObject *decode; /* bytes -> message */
    const struct shape *shape;
    const char *complaint; /* about bytes that are not of this type */
    bool has_complained;
};

struct message {
    struct codec *codec;
    char *data;
    size_t size;
    size_t capacity;
};

struct message *new_message(struct codec *codec)
{
    struct message *message = calloc(1, sizeof(struct message));

    if (message)
        message->codec = codec;
    return message;
}

void destroy_message(struct message *message)
{
    if (message)
        free(message->data);
    free(message);
}

bool set_data(struct message *message, const char *data, size_t size)
{
    if (size > message->capacity) {
        char *larger = realloc(message->data, size);

        if (!larger)
            return false;
        message->data = larger;
        message->capacity = size;
    }
    memcpy(message->data, data, size);
    message->size = size;
    return true;
}

bool convert_from_py(PyObject *value, struct message *message)
{
    char *data;
    ptrdiff_t size;
    bool done = false;
    PyObject *bytes = PyObject_CallFunctionObjArgs(message->codec->encode, value, NULL);

    if (!bytes)
        return false;
    if (PyBytes_AsStringAndSize(bytes, &data, &size) == 0) {
        done = set_data(message, data, size);
        if (!done)
            PyErr_NoMemory();
    }
    Py_DecRef(bytes);
    return done;
}

PyObject *convert_to_py(const struct message *message)
{
    PyObject *value, *bytes = PyBytes_FromStringAndSize(message->data, message->size);

    if (!bytes)
        return NULL;
    value = PyObject_CallFunctionObjArgs(message->codec->decode, bytes, NULL);
    Py_DecRef(bytes);
    return value;
}

/* ---- what Fast DDS calls: message_type_support_callbacks_t ------------------------------------ */

bool serialize(const struct message *message, struct cdr *cdr)
{
    if (!fast_cdr.jump(cdr, message->size))
        return false;
    memcpy(fast_cdr.position(cdr) - message->size, message->data, message->size);
    return true;
}

bool deserialize(struct cdr *cdr, struct message *message)
{
    const char *header = cdr->buffer->data, *begin = fast_cdr.position(cdr);
    size_t size = header + cdr->buffer->size - begin;
    struct codec *codec = message->codec;

    if (begin - header == 4 && header[0] == 0 && header[1] == 1 /* CDR, little endian */
        && end_of(codec->shape, begin, size, 0) <= size)
        return set_data(message, begin, size) && fast_cdr.jump(cdr, size);
    if (!codec->has_complained)
        write(2, codec->complaint, strlen(codec->complaint));
    codec->has_complained = true;
    return false;
}

unsigned serialized_size(const struct message *message)
{
    return message->size;
}

size_t max_serialized_size(char *bounds)
{
    *bounds = 0; /* ROSIDL_TYPESUPPORT_FASTRTPS_UNBOUNDED_TYPE: its buffers grow when needed */
    return 0;
}

/* ---- type supports: what rosidl_runtime_c says, and behind it what its functions return -------- */

struct description {
    const void *next; /* the same type for another middleware's way to see it */
    const void *hash;
    const void *type;
    const void *sources;
};

struct message_type_support {
    const char *identifier;
    const void *pointers[5];
    struct description description;
};

struct service_type_support {
    const char *identifier;
    const void *pointers[10];
    struct description description;
};

struct action_type_support {
    const void *pointers[8];
    struct description description;
};

#define FIND(kind)                                                                                 \
    const void *kind##_find(const struct kind##_type_support *support, const char *identifier)     \
    {                                                                                              \
        while (support && strcmp(support->identifier, identifier) != 0)                            \
            support = support->description.next;                                                   \
        return support;                                                                            \
    }

#define GET(kind, part)                                                                            \
    const void *kind##_##part(const struct kind##_type_support *support)                           \
    {                                                                                              \
        return support->description.part;                                                          \
    }

FIND(message) GET(message, hash) GET(message, type) GET(message, sources)
FIND(service) GET(service, hash) GET(service, type) GET(service, sources)
GET(action, hash) GET(action, type) GET(action, sources)

bool destroy_event(struct message *event, const void *allocator)
{
    destroy_message(event);
    return true;
}
