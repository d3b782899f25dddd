// A stable sort of what has keys.
#pragma once

#include <stdint.h>

// Sorts `order`, `count` indices of keys, by these; equal ones keep their order. `spare` has room for as many.
template <typename Key>
void sort_by_key(const Key* keys, int64_t count, int32_t* order, int32_t* spare) {
    int32_t *from = order, *to = spare;
    for (int64_t run = 1; run < count; run *= 2) {
        for (int64_t low = 0; low < count; low += 2 * run) {
            int64_t middle = low + run < count ? low + run : count;
            int64_t high = low + 2 * run < count ? low + 2 * run : count;
            for (int64_t a = low, b = middle, out = low; out < high; ++out)
                to[out] = a < middle && (b >= high || keys[from[a]] <= keys[from[b]]) ? from[a++] : from[b++];
        }
        int32_t* swapped = from;
        from = to;
        to = swapped;
    }
    if (from != order)
        for (int64_t i = 0; i < count; ++i)
            order[i] = from[i];
}
