/* Reads the golden bytes of every message by the C reader and prints their values: a line of the message, then one of
 * path and value each. Bodies that are cut off, and what a newer version appends, are tried too.
 *
 * golden GOLDEN.txt */
#include "maulstick.h"

#include <stdlib.h>

static void fail(const char *message, const char *what)
{
    fprintf(stderr, "%s: %s\n", message, what);
    exit(1);
}

static void print(const char *path, const maulstick_value *value, void *context)
{
    size_t i;
    (void)context;
    printf("%s\t", path);
    switch (value->form) {
    case MAULSTICK_F32:
    case MAULSTICK_F64:
        printf("%.17g\n", value->number);
        break;
    case MAULSTICK_I32:
    case MAULSTICK_I64:
        printf("%lld\n", (long long)value->whole);
        break;
    case MAULSTICK_STRING:
    case MAULSTICK_ENUM:
        printf("%.*s\n", (int)value->length, value->text);
        break;
    case MAULSTICK_BYTES:
        for (i = 0; i < value->length; i++)
            printf("%02x", (unsigned char)value->text[i]);
        printf("\n");
        break;
    case MAULSTICK_ABSENT:
        printf("absent\n");
        break;
    default:
        printf("%llu\n", (unsigned long long)value->whole);
    }
}

static void ignore(const char *path, const maulstick_value *value, void *context)
{
    (void)path, (void)value, (void)context;
}

int main(int count, char **words)
{
    static char line[1 << 16], name[64];
    static uint8_t bytes[1 << 15];
    FILE *file = count == 2 ? fopen(words[1], "r") : NULL;
    if (!file)
        fail("golden", "no file is named that can be read");
    while (fgets(line, sizeof line, file)) {
        const char *hex = strrchr(line, ' ');
        const maulstick_message *message;
        maulstick_header header;
        unsigned byte;
        size_t size = 0, end;
        if (!hex || sscanf(line, "%63s", name) != 1)
            fail(line, "not a name, a version and bytes");
        for (hex++; size < sizeof bytes && sscanf(hex, "%2x", &byte) == 1; hex += 2)
            bytes[size++] = (uint8_t)byte;
        if (!maulstick_split(bytes, size, &header) || maulstick_split(bytes, size - 1, &header))
            fail(name, "its header is not read as it is");
        message = maulstick_message_of(header.schema);
        if (!message)
            fail(name, "there is no such message");
        printf("%s\n", name);
        if (!maulstick_walk(message, header.body, header.length, print, NULL))
            fail(name, "it is malformed");
        for (end = 0; end < header.length; end++) {
            /* In memory of its own length, so that a sanitizer sees what is read beyond it. */
            uint8_t *cut = (uint8_t *)malloc(end > 0 ? end : 1);
            memcpy(cut, header.body, end);
            if (maulstick_walk(message, cut, end, ignore, NULL))
                fail(name, "it is read though it is cut off");
            free(cut);
        }
        if (!maulstick_walk(message, header.body, header.length + 1, ignore, NULL))
            fail(name, "it is not read with what a newer version appends");
    }
    fclose(file);
    return 0;
}
