// Numbers of several worlds, put side by side and handed out again.
#pragma once

#include "layouts.h"

// A number of each lane, or four numbers of one.
typedef double Four __attribute__((ext_vector_type(4), aligned(8)));
static_assert(LANES == 4, "numbers are transposed four by four");

inline const double* numbers_at(const char* first, int64_t bytes) {
    return reinterpret_cast<const double*>(first + bytes);
}
inline double* numbers_at(char* first, int64_t bytes) { return reinterpret_cast<double*>(first + bytes); }

inline Four& four_at(double* at) { return *reinterpret_cast<Four*>(at); }
inline const Four& four_at(const double* at) { return *reinterpret_cast<const Four*>(at); }

// The same numbers for all worlds.
inline void repeat(const double* from, double* to, int count) {
    for (int i = 0; i < count; ++i)
        four_at(to + i * LANES) = Four(from[i]);
}

// Exchanges the rows and columns of four by four numbers.
inline void transpose(Four& a, Four& b, Four& c, Four& d) {
    const Four low_ab = __builtin_shufflevector(a, b, 0, 4, 2, 6);
    const Four high_ab = __builtin_shufflevector(a, b, 1, 5, 3, 7);
    const Four low_cd = __builtin_shufflevector(c, d, 0, 4, 2, 6);
    const Four high_cd = __builtin_shufflevector(c, d, 1, 5, 3, 7);
    a = __builtin_shufflevector(low_ab, low_cd, 0, 1, 4, 5);
    b = __builtin_shufflevector(high_ab, high_cd, 0, 1, 4, 5);
    c = __builtin_shufflevector(low_ab, low_cd, 2, 3, 6, 7);
    d = __builtin_shufflevector(high_ab, high_cd, 2, 3, 6, 7);
}

inline void put_side_by_side(
    const double* a, const double* b, const double* c, const double* d, double* to, int count
) {
    int i = 0;
    for (; i + 4 <= count; i += 4, to += 4 * LANES) {
        Four first = four_at(a + i), second = four_at(b + i), third = four_at(c + i), fourth = four_at(d + i);
        transpose(first, second, third, fourth);
        four_at(to) = first;
        four_at(to + LANES) = second;
        four_at(to + 2 * LANES) = third;
        four_at(to + 3 * LANES) = fourth;
    }
    for (; i < count; ++i, to += LANES)
        four_at(to) = Four{a[i], b[i], c[i], d[i]};
}

// Puts numbers of each lane, from addresses of their own, side by side.
inline void put_row(const double* const (&from)[LANES], double* to, int count) {
    if (from[0] == from[1] && from[0] == from[2] && from[0] == from[3])
        repeat(from[0], to, count);
    else
        put_side_by_side(from[0], from[1], from[2], from[3], to, count);
}

// Puts some rows of the worlds from `world` on side by side.
inline void gather(const LaneRows& rows, int first, int count, int world = 0) {
    const int64_t skipped = world * rows.world_stride + first * rows.row_stride;
    char* wide = rows.wide + first * rows.wide_stride;
    for (int row = 0; row < count; ++row, wide += rows.wide_stride) {
        const double* from[LANES];
        for (int lane = 0; lane < LANES; ++lane)
            from[lane] = numbers_at(rows.lone[lane], skipped + lane * rows.world_stride + row * rows.row_stride);
        put_row(from, numbers_at(wide, 0), rows.numbers);
    }
}

// Hands out some rows of a lane.
inline void scatter(const LaneRows& rows, int lane, int first, int count) {
    for (int row = first; row < first + count; ++row) {
        const double* from = numbers_at(rows.wide, row * rows.wide_stride) + lane;
        double* to = numbers_at(rows.lone[lane], row * rows.row_stride);
        int i = 0;
        for (; i + 4 <= rows.numbers; i += 4, from += 4 * LANES)
            four_at(to + i) = Four{from[0], from[LANES], from[2 * LANES], from[3 * LANES]};
        for (; i < rows.numbers; ++i, from += LANES)
            to[i] = *from;
    }
}

// Hands out all rows of all lanes.
inline void scatter_to_all(const LaneRows& rows) {
    for (int row = 0; row < rows.rows; ++row) {
        const double* from = numbers_at(rows.wide, row * rows.wide_stride);
        double* to[LANES];
        for (int lane = 0; lane < LANES; ++lane)
            to[lane] = numbers_at(rows.lone[lane], row * rows.row_stride);
        int i = 0;
        for (; i + 4 <= rows.numbers; i += 4, from += 4 * LANES) {
            Four first = four_at(from), second = four_at(from + LANES), third = four_at(from + 2 * LANES),
                 fourth = four_at(from + 3 * LANES);
            transpose(first, second, third, fourth);
            four_at(to[0] + i) = first;
            four_at(to[1] + i) = second;
            four_at(to[2] + i) = third;
            four_at(to[3] + i) = fourth;
        }
        for (; i < rows.numbers; ++i, from += LANES)
            for (int lane = 0; lane < LANES; ++lane)
                to[lane][i] = from[lane];
    }
}
