/* Reader of Maulstick's messages, C99 without libraries. `maulstick schema --c > maulstick.h` prints it with the tables
 * of all messages behind it:
 *
 *     maulstick_header header;
 *     maulstick_value pressure;
 *     if (maulstick_split(bytes, size, &header)) {
 *         const maulstick_message *message = maulstick_message_of(header.schema);
 *         if (message && maulstick_get(message, header.body, header.length, "pose.Contact.pressure", &pressure))
 *             printf("%g\n", pressure.number);
 *     }
 *
 * Nothing is allocated, and nothing is read beyond the bytes that were given, whatever they are. What a newer version
 * appended to a message is left alone. */
#ifndef MAULSTICK_H
#define MAULSTICK_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

/* Deepest nesting of a field, and longest path of one. */
enum { MAULSTICK_DEEPEST = 32, MAULSTICK_PATH = 256, MAULSTICK_HEADER_BYTES = 48 };

/* Forms of a type, and of a value. */
typedef enum {
    MAULSTICK_U8, MAULSTICK_U16, MAULSTICK_U32, MAULSTICK_U64, MAULSTICK_I32, MAULSTICK_I64,
    MAULSTICK_F32, MAULSTICK_F64, MAULSTICK_BOOL,
    MAULSTICK_STRING, /* UTF-8, without a null at its end */
    MAULSTICK_BYTES, MAULSTICK_LIST, MAULSTICK_ARRAY, MAULSTICK_OPTION, MAULSTICK_STRUCT, MAULSTICK_ENUM,
    MAULSTICK_ABSENT /* an option without a value */
} maulstick_form;

/* A field of a struct, or an alternative of an enum, whose type is a struct. */
typedef struct {
    const char *name;
    uint16_t type;
} maulstick_field;

typedef struct {
    maulstick_form form;
    uint16_t first; /* of a struct and an enum: place of its first field; else of the inner type */
    uint16_t count; /* fields, alternatives or elements of an array */
} maulstick_type;

/* A message of this version of Maulstick. */
typedef struct {
    const char *name;
    uint32_t schema; /* as its header has it */
    uint16_t version;
    uint16_t type;
    const maulstick_type *types;
    const maulstick_field *fields;
} maulstick_message;

/* The header of a message. Times are on the rig's clock, ns; `length` is that of the body, bytes. */
typedef struct {
    uint16_t version;
    uint32_t schema, source, epoch, flags, length;
    uint64_t seq, event_ns, sent_ns;
    const uint8_t *body;
} maulstick_header;

/* A value. It points into the message, which has to outlive it. */
typedef struct {
    maulstick_form form;
    double number;    /* of any number and of a bool */
    uint64_t whole;   /* of a bool and a whole number, a negative one as its two's complement; of a list: its elements */
    const char *text; /* of a string and of bytes; of an enum: the name of its alternative */
    size_t length;    /* of the text, bytes */
} maulstick_value;

/* Receives a value and its path, such as "pose.Contact.point_m.0". */
typedef void (*maulstick_visitor)(const char *path, const maulstick_value *value, void *context);

typedef struct {
    const maulstick_message *message;
    const uint8_t *at;
    size_t left;
    char path[MAULSTICK_PATH];
    maulstick_visitor visit;
    void *context;
} maulstick_reader;

/* The unsigned number of `size` bytes, little endian. */
static inline uint64_t maulstick_unsigned(const uint8_t *bytes, size_t size)
{
    uint64_t value = 0;
    while (size-- > 0)
        value = value << 8 | bytes[size];
    return value;
}

/* Header of a message; false for bytes that are none. */
static inline bool maulstick_split(const void *message, size_t size, maulstick_header *header)
{
    const uint8_t *bytes = (const uint8_t *)message;
    if (size < MAULSTICK_HEADER_BYTES || maulstick_unsigned(bytes, 2) != 0x4d4c)
        return false;
    header->version = (uint16_t)maulstick_unsigned(bytes + 2, 2);
    header->schema = (uint32_t)maulstick_unsigned(bytes + 4, 4);
    header->source = (uint32_t)maulstick_unsigned(bytes + 8, 4);
    header->epoch = (uint32_t)maulstick_unsigned(bytes + 12, 4);
    header->flags = (uint32_t)maulstick_unsigned(bytes + 16, 4);
    header->length = (uint32_t)maulstick_unsigned(bytes + 20, 4);
    header->seq = maulstick_unsigned(bytes + 24, 8);
    header->event_ns = maulstick_unsigned(bytes + 32, 8);
    header->sent_ns = maulstick_unsigned(bytes + 40, 8);
    header->body = bytes + MAULSTICK_HEADER_BYTES;
    return header->length == size - MAULSTICK_HEADER_BYTES;
}

/* Takes `size` bytes; NULL where there are fewer. */
static inline const uint8_t *maulstick_take(maulstick_reader *reader, uint64_t size)
{
    const uint8_t *taken = reader->at;
    if (size > reader->left)
        return NULL;
    reader->at += (size_t)size;
    reader->left -= (size_t)size;
    return taken;
}

/* Takes an unsigned number of `size` bytes. */
static inline bool maulstick_take_unsigned(maulstick_reader *reader, size_t size, uint64_t *value)
{
    const uint8_t *bytes = maulstick_take(reader, size);
    if (bytes)
        *value = maulstick_unsigned(bytes, size);
    return bytes != NULL;
}

/* Takes a number or a bool of the value's form. */
static inline bool maulstick_take_number(maulstick_reader *reader, maulstick_value *value)
{
    static const uint8_t sizes[] = {1, 2, 4, 8, 4, 8, 4, 8, 1};
    float single;
    uint32_t bits;
    if (!maulstick_take_unsigned(reader, sizes[value->form], &value->whole))
        return false;
    bits = (uint32_t)value->whole;
    value->number = (double)value->whole;
    if (value->form == MAULSTICK_I32)
        value->whole = (uint64_t)(int64_t)(int32_t)bits;
    if (value->form == MAULSTICK_I32 || value->form == MAULSTICK_I64)
        value->number = (double)(int64_t)value->whole;
    if (value->form == MAULSTICK_F32) {
        memcpy(&single, &bits, 4);
        value->number = single;
    }
    if (value->form == MAULSTICK_F64)
        memcpy(&value->number, &value->whole, 8);
    return value->form != MAULSTICK_BOOL || bits < 2;
}

static inline bool maulstick_read(maulstick_reader *reader, uint16_t of, size_t path, int depth);

/* Reads a part of a value whose path has `path` characters: the field of a name, or without one the element of a place. */
static inline bool maulstick_read_part(maulstick_reader *reader, const char *name, unsigned long place, uint16_t of,
                                       size_t path, int depth)
{
    char *end = reader->path + path;
    size_t room = MAULSTICK_PATH - path;
    const char *dot = path > 0 ? "." : "";
    int added = name ? snprintf(end, room, "%s%s", dot, name) : snprintf(end, room, "%s%lu", dot, place);
    if (added < 0 || (size_t)added >= room || !maulstick_read(reader, of, path + (size_t)added, depth + 1))
        return false;
    *end = '\0';
    return true;
}

/* Reads a value of a type and hands it on. */
static inline bool maulstick_read(maulstick_reader *reader, uint16_t of, size_t path, int depth)
{
    const maulstick_type *type = &reader->message->types[of];
    const maulstick_field *fields = reader->message->fields;
    maulstick_value value;
    uint64_t count = type->count, place;
    memset(&value, 0, sizeof value);
    value.form = type->form;
    if (depth > MAULSTICK_DEEPEST)
        return false;
    switch (type->form) {
    case MAULSTICK_STRUCT:
        for (place = type->first; place < type->first + count; place++)
            if (!maulstick_read_part(reader, fields[place].name, 0, fields[place].type, path, depth))
                return false;
        return true;
    case MAULSTICK_ENUM:
        if (!maulstick_take_unsigned(reader, 4, &place) || place >= count)
            return false;
        place += type->first;
        value.text = fields[place].name;
        value.length = strlen(value.text);
        reader->visit(reader->path, &value, reader->context);
        return maulstick_read_part(reader, value.text, 0, fields[place].type, path, depth);
    case MAULSTICK_OPTION:
        if (!maulstick_take_unsigned(reader, 1, &count) || count > 1)
            return false;
        if (count == 1)
            return maulstick_read(reader, type->first, path, depth + 1);
        value.form = MAULSTICK_ABSENT;
        break;
    case MAULSTICK_LIST:
        if (!maulstick_take_unsigned(reader, 8, &count))
            return false;
        /* fall through */
    case MAULSTICK_ARRAY:
        if (count > reader->left) /* no element is without bytes */
            return false;
        value.whole = count;
        reader->visit(reader->path, &value, reader->context);
        for (place = 0; place < count; place++)
            if (!maulstick_read_part(reader, NULL, (unsigned long)place, type->first, path, depth))
                return false;
        return true;
    case MAULSTICK_STRING:
    case MAULSTICK_BYTES:
        if (!maulstick_take_unsigned(reader, 8, &count))
            return false;
        value.text = (const char *)maulstick_take(reader, count);
        value.length = (size_t)count;
        if (!value.text)
            return false;
        break;
    default:
        if (!maulstick_take_number(reader, &value))
            return false;
    }
    reader->visit(reader->path, &value, reader->context);
    return true;
}

/* Calls `visit` with each value of a body, in order. False where the body is malformed or too short; what was visited
 * until then was there. */
static inline bool maulstick_walk(const maulstick_message *message, const void *body, size_t size,
                                  maulstick_visitor visit, void *context)
{
    maulstick_reader reader;
    reader.message = message;
    reader.at = (const uint8_t *)body;
    reader.left = size;
    reader.path[0] = '\0';
    reader.visit = visit;
    reader.context = context;
    return maulstick_read(&reader, message->type, 0, 0);
}

typedef struct {
    const char *path;
    maulstick_value *value;
    bool found;
} maulstick_wanted;

static inline void maulstick_compare(const char *path, const maulstick_value *value, void *context)
{
    maulstick_wanted *wanted = (maulstick_wanted *)context;
    if (strcmp(path, wanted->path) == 0) {
        *wanted->value = *value;
        wanted->found = true;
    }
}

/* The value at a path, such as "pose.Contact.pressure". False where there is none, as in another alternative or behind
 * the end of a list, and where the body is malformed. It walks the whole body: for many values of one use maulstick_walk. */
static inline bool maulstick_get(const maulstick_message *message, const void *body, size_t size, const char *path,
                                 maulstick_value *value)
{
    maulstick_wanted wanted;
    wanted.path = path;
    wanted.value = value;
    wanted.found = false;
    return maulstick_walk(message, body, size, maulstick_compare, &wanted) && wanted.found;
}

#endif
