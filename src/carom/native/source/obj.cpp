// Takes OBJ files apart as programs write them: `carom.formats.mesh.plain_obj`; finds distinct corners:
// `carom.formats.visuals.plain_obj`.
//
// What is unusual or broken is left to Python, which understands more of it, and says where it is broken. Files end
// with a line break, which is `\n`.

#include "export.h"

#include <stdint.h>

namespace {

// Kinds of lines. Numbers of the first three are also those of the entries of a corner.
enum Kind { POSITION, UV, NORMAL, FACE, OTHER, NOTHING };

// Powers of ten that are exact, so that a single division or multiplication rounds correctly.
const double POWERS[] = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,  1e8,  1e9,  1e10, 1e11,
                         1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};
const int64_t MOST_POWERS = 22;
// Digits that may be followed by another one: all together are a whole number that is exact.
const uint64_t MOST_DIGITS = ((UINT64_C(1) << 53) - 10) / 10;
const int64_t MOST_INDEX = INT64_C(1) << 40;

bool is_blank(char c) { return c == ' ' || c == '\t'; }
bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool ends_word(char c) { return is_blank(c) || c == '\n'; }

// Goes behind the keyword of a line, and says which it is.
Kind keyword(const char*& at) {
    while (is_blank(*at))
        ++at;
    if (*at == '\n' || *at == '#')
        return NOTHING;
    const char* word = at;
    Kind kind = OTHER;
    if (*at == 'f')
        kind = FACE, ++at;
    else if (*at == 'v') {
        ++at;
        kind = *at == 't' ? UV : *at == 'n' ? NORMAL : POSITION;
        at += kind != POSITION;
    }
    if (is_blank(*at))
        return kind;
    at = word;
    return OTHER;
}

int64_t count_words(const char*& at) {
    int64_t count = 0;
    for (; *at != '\n'; ++at)
        count += !is_blank(*at) && is_blank(at[-1]);
    return count;
}

// Reads a number; false if it is broken, or has too many digits for the short way.
bool read_number(const char*& at, double& value) {
    while (is_blank(*at))
        ++at;
    bool is_negative = *at == '-', has_point = false, has_digits = false;
    at += is_negative;
    uint64_t digits = 0;
    int64_t power = 0;
    for (;; ++at) {
        if (*at == '.' && !has_point) {
            has_point = true;
            continue;
        }
        if (!is_digit(*at))
            break;
        if (digits > MOST_DIGITS)
            return false;
        digits = 10 * digits + static_cast<uint64_t>(*at - '0');
        has_digits = true;
        power -= has_point;
    }
    if (*at == 'e' || *at == 'E') {
        ++at;
        bool is_fraction = *at == '-';
        at += is_fraction || *at == '+';
        if (!is_digit(*at))
            return false;
        int64_t exponent = 0;
        for (; is_digit(*at) && exponent < 1000; ++at)
            exponent = 10 * exponent + (*at - '0');
        power += is_fraction ? -exponent : exponent;
    }
    if (!has_digits || !ends_word(*at) || power < -MOST_POWERS || power > MOST_POWERS)
        return false;
    value = static_cast<double>(digits);
    value = power < 0 ? value / POWERS[-power] : value * POWERS[power];
    if (is_negative)
        value = -value;
    return true;
}

// Reads an index, from 1 or back from those known so far, as one from 0; false if there is no such entry.
bool read_index(const char*& at, int64_t known, int64_t count, int64_t& index) {
    bool is_negative = *at == '-';
    at += is_negative;
    int64_t number = 0;
    for (; is_digit(*at) && number < MOST_INDEX; ++at)
        number = 10 * number + (*at - '0');
    index = is_negative ? known - number : number - 1;
    return number > 0 && index >= 0 && index < count;
}

// Reads `1`, `1/2`, `1//3` or `1/2/3`; entries that are left out are -1.
bool read_corner(const char*& at, const int64_t* known, const int64_t* counts, int64_t* corner) {
    corner[UV] = corner[NORMAL] = -1;
    if (!read_index(at, known[POSITION], counts[POSITION], corner[POSITION]))
        return false;
    if (*at == '/') {
        ++at;
        if (*at != '/' && !read_index(at, known[UV], counts[UV], corner[UV]))
            return false;
        if (*at == '/' && !read_index(++at, known[NORMAL], counts[NORMAL], corner[NORMAL]))
            return false;
    }
    return ends_word(*at);
}

// Reads a polygon as triangles that share its first corner.
bool read_face(const char*& at, const int64_t* known, const int64_t* counts, int64_t*& triangles) {
    int64_t first[3], last[3], corner[3];
    for (int64_t number = 0;; ++number) {
        while (is_blank(*at))
            ++at;
        if (*at == '\n')
            return true;
        if (!read_corner(at, known, counts, corner))
            return false;
        for (int kind = 0; kind < 3; ++kind) {
            if (number == 0)
                first[kind] = corner[kind];
            if (number > 1)
                triangles[kind] = first[kind], triangles[3 + kind] = last[kind], triangles[6 + kind] = corner[kind];
            last[kind] = corner[kind];
        }
        triangles += number > 1 ? 9 : 0;
    }
}

// Sorts the indices of corners by one of the entries; corners with the same one keep their order. There are so many
// values, with -1, and `starts` has room for one more.
void sort_by(
    const int64_t* corners, int kind, int64_t values, int64_t count, const int64_t* from, int64_t* to, int64_t* starts
) {
    for (int64_t n = 0; n <= values; ++n)
        starts[n] = 0;
    for (int64_t n = 0; n < count; ++n)
        ++starts[corners[3 * n + kind] + 2];
    for (int64_t n = 0; n < values; ++n)
        starts[n + 1] += starts[n];
    for (int64_t n = 0; n < count; ++n)
        to[starts[corners[3 * from[n] + kind] + 1]++] = from[n];
}

}  // namespace

// Counts positions, texture coordinates, normals, triangles, and lines of other kinds.
extern "C" CAROM_EXPORT void carom_count_obj(const char* data, int64_t length, int64_t* counts) {
    for (const char *at = data, *end = data + length; at < end; ++at) {
        Kind kind = keyword(at);
        if (kind == FACE) {
            int64_t corners = count_words(at);
            counts[FACE] += corners > 2 ? corners - 2 : 0;
        } else if (kind != NOTHING)
            ++counts[kind];
        while (*at != '\n')
            ++at;
    }
}

// Reads what was counted: (n, 3) positions, (n, 2) texture coordinates, (n, 3) normals, the corners of triangles
// (n, 3, 3), and of each other line where it begins and how many faces and triangles are before it. Returns the number
// of faces; -1 if Python has to read the file.
extern "C" CAROM_EXPORT int64_t carom_read_obj(
    const char* data, int64_t length, const int64_t* counts, double* const* numbers, int64_t* triangles, int64_t* others
) {
    const int widths[] = {3, 2, 3};
    const int64_t* first = triangles;
    double* next[] = {numbers[0], numbers[1], numbers[2]};
    int64_t known[] = {0, 0, 0}, faces = 0;
    for (const char *at = data, *end = data + length; at < end; ++at) {
        const char* line = at;
        Kind kind = keyword(at);
        if (kind == FACE) {
            if (!read_face(at, known, counts, triangles))
                return -1;
            ++faces;
        } else if (kind == OTHER) {
            *others++ = line - data;
            *others++ = faces;
            *others++ = (triangles - first) / 9;
        } else if (kind != NOTHING) {
            for (int n = 0; n < widths[kind]; ++n)
                if (!read_number(at, *next[kind]++))
                    return -1;
            ++known[kind];
        }
        while (*at != '\n')
            ++at;
    }
    return faces;
}

// Finds the distinct ones of (count, 3) corners, sorted by position, texture coordinate and normal, of which there are
// `sizes`. Writes the index of the first of each, and the number that each corner has among them; returns how many
// there are. Two rows of `work` have `count` entries, the next one two more than the greatest size.
extern "C" CAROM_EXPORT int64_t carom_distinct_corners(
    const int64_t* corners, int64_t count, const int64_t* sizes, int64_t* first, int32_t* number, int64_t* work
) {
    int64_t *order = work, *spare = work + count, *starts = work + 2 * count;
    for (int64_t n = 0; n < count; ++n)
        order[n] = n;
    for (int kind = NORMAL; kind >= POSITION; --kind) {
        sort_by(corners, kind, sizes[kind] + 1, count, order, spare, starts);
        int64_t* sorted = spare;
        spare = order;
        order = sorted;
    }
    int64_t found = 0;
    const int64_t* last = nullptr;
    for (int64_t n = 0; n < count; ++n) {
        const int64_t* corner = corners + 3 * order[n];
        if (!last || corner[0] != last[0] || corner[1] != last[1] || corner[2] != last[2])
            first[found++] = order[n];
        last = corner;
        number[order[n]] = static_cast<int32_t>(found - 1);
    }
    return found;
}
