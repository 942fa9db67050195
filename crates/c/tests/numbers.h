/* Reads a file of doubles, and keeps the doubles that are to be written. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static double *numbers_in, *numbers_out;
static size_t in_at, in_count, out_count, out_room;

static void read_numbers(const char *path) {
    FILE *file = fopen(path, "rb");
    if (file == NULL || fseek(file, 0, SEEK_END) != 0) exit(2);
    const long bytes = ftell(file);
    rewind(file);
    in_count = (size_t)bytes / sizeof(double);
    numbers_in = (double *)malloc((size_t)bytes);
    if (fread(numbers_in, sizeof(double), in_count, file) != in_count) exit(2);
    fclose(file);
}

static const double *take(size_t count) {
    const double *start = numbers_in + in_at;
    in_at += count;
    if (in_at > in_count) exit(2);
    return start;
}

static double number(void) { return *take(1); }
static size_t count(void) { return (size_t)number(); }

static void put(double value) {
    if (out_count == out_room) {
        out_room = 2 * out_room + 1024;
        numbers_out = (double *)realloc(numbers_out, out_room * sizeof(double));
    }
    /* One NaN for all. */
    numbers_out[out_count++] = isnan(value) ? NAN : value;
}

static void put_all(const double *values, size_t many) {
    for (size_t k = 0; k < many; ++k) put(values[k]);
}

static void write_numbers(const char *path) {
    FILE *file = fopen(path, "wb");
    if (file == NULL || fwrite(numbers_out, sizeof(double), out_count, file) != out_count) exit(2);
    fclose(file);
    free(numbers_in);
    free(numbers_out);
}
