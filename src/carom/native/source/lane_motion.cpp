// Free motion of several worlds at once: their numbers are put side by side, a kernel computes with all of them, and each
// world takes its results.

#include "lane_motion.h"

#include "perform.h"

namespace {

// A number of each lane, or four numbers of one.
typedef double Four __attribute__((ext_vector_type(4), aligned(8)));
static_assert(LANES == 4, "numbers are transposed four by four");

const double* numbers_at(const char* first, int64_t bytes) { return reinterpret_cast<const double*>(first + bytes); }
double* numbers_at(char* first, int64_t bytes) { return reinterpret_cast<double*>(first + bytes); }

Four& four_at(double* at) { return *reinterpret_cast<Four*>(at); }
const Four& four_at(const double* at) { return *reinterpret_cast<const Four*>(at); }

// The same numbers for all worlds.
void repeat(const double* from, double* to, int count) {
    for (int i = 0; i < count; ++i)
        four_at(to + i * LANES) = Four(from[i]);
}

void put_side_by_side(const double* a, const double* b, const double* c, const double* d, double* to, int count) {
    int i = 0;
    for (; i + 4 <= count; i += 4, to += 4 * LANES) {
        const Four low_ab = __builtin_shufflevector(four_at(a + i), four_at(b + i), 0, 4, 2, 6);
        const Four high_ab = __builtin_shufflevector(four_at(a + i), four_at(b + i), 1, 5, 3, 7);
        const Four low_cd = __builtin_shufflevector(four_at(c + i), four_at(d + i), 0, 4, 2, 6);
        const Four high_cd = __builtin_shufflevector(four_at(c + i), four_at(d + i), 1, 5, 3, 7);
        four_at(to) = __builtin_shufflevector(low_ab, low_cd, 0, 1, 4, 5);
        four_at(to + LANES) = __builtin_shufflevector(high_ab, high_cd, 0, 1, 4, 5);
        four_at(to + 2 * LANES) = __builtin_shufflevector(low_ab, low_cd, 2, 3, 6, 7);
        four_at(to + 3 * LANES) = __builtin_shufflevector(high_ab, high_cd, 2, 3, 6, 7);
    }
    for (; i < count; ++i, to += LANES)
        four_at(to) = Four{a[i], b[i], c[i], d[i]};
}

void gather(const LaneRows& rows, int first) {
    const char* lone = rows.lone + first * rows.world_stride;
    for (int row = 0; row < rows.rows; ++row, lone += rows.row_stride) {
        double* to = numbers_at(rows.wide, row * rows.wide_stride);
        const double* from[LANES];
        for (int lane = 0; lane < LANES; ++lane)
            from[lane] = numbers_at(lone, lane * rows.world_stride);
        if (rows.world_stride == 0)
            repeat(from[0], to, rows.numbers);
        else
            put_side_by_side(from[0], from[1], from[2], from[3], to, rows.numbers);
    }
}

void scatter(const LaneRows& rows, int lane) {
    for (int row = 0; row < rows.rows; ++row) {
        const double* from = numbers_at(rows.wide, row * rows.wide_stride) + lane;
        double* to = numbers_at(rows.lone, row * rows.row_stride);
        int i = 0;
        for (; i + 4 <= rows.numbers; i += 4, from += 4 * LANES)
            four_at(to + i) = Four{from[0], from[LANES], from[2 * LANES], from[3 * LANES]};
        for (; i < rows.numbers; ++i, from += LANES)
            to[i] = *from;
    }
}

// Where some world has joint terms and another has none, adding 0 would change the sign of a zero.
bool are_alike(const LaneMotion& lanes) {
    for (int tree = 0; tree < lanes.tree_count; ++tree)
        for (int lane = 1; lane < LANES; ++lane) {
            const double* terms = lanes.joint_terms + tree * LANES;
            if ((terms[lane] != 0.0) != (terms[0] != 0.0))
                return false;
        }
    return true;
}

}  // namespace

bool prepare_motion(const LaneMotion& lanes, int first) {
    for (int i = 0; i < lanes.gathered_count; ++i)
        gather(lanes.gathered[i], first);
    if (!are_alike(lanes))
        return false;
    run(lanes.motion);
    ++*lanes.steps_begun;
    return true;
}

void hand_over_motion(const LaneMotion& lanes, int lane) {
    for (int i = 0; i < lanes.scattered_count; ++i)
        scatter(lanes.scattered[i], lane);
}
