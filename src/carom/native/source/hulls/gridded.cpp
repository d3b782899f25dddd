// Hulls of points on Bullet's grid, in one call: `carom.geometry.gridded`. Operations and their order are those of
// `carom.geometry.hull` and `carom.geometry.corner_order`, so that both give the same bits.

#include "export.h"
#include "layouts.h"
#include "sorting.h"

extern "C" CAROM_EXPORT int64_t carom_hull(HullWork* work);
extern "C" CAROM_EXPORT void carom_merge_faces(MergeWork* work, int64_t least_faces);
extern "C" CAROM_EXPORT int64_t carom_corner_order(CornerWork* work);

namespace {

// What a hull is made with, see `carom.geometry.gridded`.
struct Numbers {
    double flat, rounding, tolerance, coplanar, parallel, tiny, smallest, largest, grid;
};

enum Outcome { DONE, NO_ROOM, LEFT_TO_PYTHON };

const int64_t LEAST_FACES = 4, FACES_PER_VERTEX = 12, FEWEST_FACES = 256, SPOKES_PER_POINT = 32;

// Hands out one piece of memory; with none, only counts bytes.
struct Room {
    char* memory;
    int64_t used = 0;

    template <typename T>
    T* take(int64_t count) {
        T* taken = memory ? reinterpret_cast<T*>(memory + used) : nullptr;
        used += (count * static_cast<int64_t>(sizeof(T)) + 15) / 16 * 16;
        return taken;
    }
};

struct Sizes {
    int64_t count, total, most_vertices, factor;

    int64_t vertices() const { return count < most_vertices ? count : most_vertices; }
    int64_t faces() const {
        int64_t expected = FACES_PER_VERTEX * vertices();
        return 2 * factor * (expected > FEWEST_FACES ? expected : FEWEST_FACES);
    }
    // By Euler's formula.
    int64_t triangles() const { return 2 * vertices() + LEAST_FACES; }
    int64_t spokes() const { return factor * SPOKES_PER_POINT * count; }
};

// All memory of a hull. Results are the first three arrays.
struct Memory {
    double* vertices;
    int32_t *corners, *counts;
    double *centred, *cells;
    int64_t* keys;
    int32_t *order, *spare, *number, *firsts, *sorted, *rank, *place;
    HullWork hull{};
    MergeWork merge{};
    CornerWork listing{};
    int32_t* point_of;

    Memory(Room& room, const Sizes& sizes) {
        int64_t n = sizes.count, faces = sizes.faces(), triangles = sizes.triangles(), spokes = sizes.spokes();
        vertices = room.take<double>(3 * n);
        corners = merge.corners = room.take<int32_t>(3 * triangles);
        counts = merge.counts = room.take<int32_t>(triangles);
        centred = room.take<double>(3 * n);
        cells = room.take<double>(3 * n);
        keys = room.take<int64_t>(n);
        int32_t** of_points[] = {&order, &spare, &number, &firsts, &rank, &place};
        for (int32_t** each : of_points)
            *each = room.take<int32_t>(n);
        sorted = room.take<int32_t>(3 * n);
        point_of = room.take<int32_t>(sizes.total);
        hull.faces = room.take<HullFace>(faces);
        hull.queue = room.take<HullEntry>(faces);
        hull.rim = room.take<HullEdge>(faces);
        hull.loop = room.take<HullEdge>(faces);
        hull.seen = room.take<int32_t>(faces);
        int32_t** of_growth[] = {&hull.next, &hull.rim_at, &hull.rim_of};
        for (int32_t** each : of_growth)
            *each = room.take<int32_t>(n);
        merge.normals = room.take<double>(3 * triangles);
        merge.areas = room.take<double>(triangles);
        merge.number = room.take<int32_t>(faces);
        int32_t** of_triangles[] = {&merge.face, &merge.order, &merge.spare, &merge.group_of, &merge.group};
        for (int32_t** each : of_triangles)
            *each = room.take<int32_t>(triangles);
        int32_t** of_loops[] = {&merge.following, &merge.following_of, &merge.uses};
        for (int32_t** each : of_loops)
            *each = room.take<int32_t>(n);
        listing.outline = room.take<int32_t>(4 * n);
        int32_t** of_corners[] = {&listing.lead, &listing.seen, &listing.order};
        for (int32_t** each : of_corners)
            *each = room.take<int32_t>(n);
        int32_t** of_spokes[] = {&listing.far, &listing.after, &listing.before};
        for (int32_t** each : of_spokes)
            *each = room.take<int32_t>(spokes);
        listing.bridges = room.take<int32_t>(3 * spokes);
    }
};

double absolute(double x) { return x < 0.0 ? -x : x; }
double dot(const double* a, const double* b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

void cross(const double* a, const double* b, double* out) {
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

void subtract(const double* a, const double* b, double* out) {
    for (int k = 0; k < 3; ++k)
        out[k] = a[k] - b[k];
}

struct Box {
    double low[3], high[3];

    Box(const double* points, int64_t count) {
        for (int k = 0; k < 3; ++k)
            low[k] = high[k] = points[k];
        for (int64_t n = 1; n < count; ++n)
            for (int k = 0; k < 3; ++k) {
                double x = points[3 * n + k];
                low[k] = x < low[k] ? x : low[k];
                high[k] = x > high[k] ? x : high[k];
            }
    }
};

// The part of a vector that is not along a unit vector.
void aside_of(const double* away, const double* along, double* aside) {
    double amount = dot(away, along);
    for (int k = 0; k < 3; ++k)
        aside[k] = away[k] - amount * along[k];
}

bool is_finite(const double* points, int64_t numbers) {
    for (int64_t n = 0; n < numbers; ++n)
        if (!(points[n] - points[n] == 0.0))
            return false;
    return true;
}

// Four points that span a volume, or fewer if all lie in a plane, on a line or in one point.
int first_corners(const double* points, int64_t count, double thin, int32_t* corners) {
    Box box(points, count);
    int axis = 0;
    for (int k = 1; k < 3; ++k)
        if (box.high[k] - box.low[k] > box.high[axis] - box.low[axis])
            axis = k;
    int64_t found = 0;
    for (int64_t n = 1; n < count; ++n)
        if (points[3 * n + axis] < points[3 * found + axis])
            found = n;
    corners[0] = static_cast<int32_t>(found);
    const double* first = points + 3 * found;
    double away[3], along[3], aside[3], normal[3], greatest = -1.0;
    auto farthest = [&](auto distance) {
        greatest = -1.0;
        int64_t at = 0;
        for (int64_t n = 0; n < count; ++n) {
            subtract(points + 3 * n, first, away);
            double here = distance();
            if (here > greatest) {
                greatest = here;
                at = n;
            }
        }
        subtract(points + 3 * at, first, away);
        return static_cast<int32_t>(at);
    };
    corners[1] = farthest([&] { return __builtin_sqrt(dot(away, away)); });
    if (greatest <= thin || greatest == 0.0)
        return 1;
    for (int k = 0; k < 3; ++k)
        along[k] = away[k] / greatest;
    corners[2] = farthest([&] {
        aside_of(away, along, aside);
        return __builtin_sqrt(dot(aside, aside));
    });
    if (greatest <= thin)
        return 2;
    aside_of(away, along, aside);
    cross(along, aside, normal);
    double length = __builtin_sqrt(dot(normal, normal));
    for (int k = 0; k < 3; ++k)
        normal[k] /= length;
    corners[3] = farthest([&] { return absolute(dot(away, normal)); });
    return greatest <= thin ? 3 : 4;
}

struct GriddedHull {
    const double* points;
    const int32_t* uses;  // null for one of each
    const Sizes& sizes;
    const Numbers& numbers;
    Memory& m;
    int64_t results[3] = {0, 0, 0};

    Outcome make() {
        if (!is_finite(points, 3 * sizes.count))
            return LEFT_TO_PYTHON;
        Box box(points, sizes.count);
        double middle[3], size = 0.0;
        for (int k = 0; k < 3; ++k)
            middle[k] = 0.5 * (box.low[k] + box.high[k]);
        for (int64_t n = 0; n < 3 * sizes.count; ++n) {
            m.centred[n] = points[n] - middle[n % 3];
            double here = absolute(m.centred[n]);
            size = here > size ? here : size;
        }
        if (!(size < numbers.largest) || size < numbers.smallest)
            return LEFT_TO_PYTHON;
        int32_t first[4];
        if (first_corners(m.centred, sizes.count, numbers.flat * size, first) < 4)
            return LEFT_TO_PYTHON;
        if (!wrap(first, size))
            return NO_ROOM;
        double step[3];
        for (int k = 0; k < 3; ++k)
            step[k] = (box.high[k] - box.low[k]) * (1.0 / numbers.grid);
        if (!list(box, step, middle))
            return NO_ROOM;
        arrange(step, middle);
        return DONE;
    }

    // Faces of the points, those in one plane joined.
    bool wrap(const int32_t* first, double size) {
        HullWork& w = m.hull;
        w.points = m.centred;
        w.count = sizes.count;
        w.most_vertices = sizes.most_vertices;
        w.most_faces = sizes.faces();
        w.rounding = numbers.rounding * size;
        w.tolerance = numbers.tolerance * size;
        for (int k = 0; k < 4; ++k)
            w.first_corners[k] = first[k];
        double p[3], q[3], r[3], up[3];
        subtract(m.centred + 3 * first[1], m.centred + 3 * first[0], p);
        subtract(m.centred + 3 * first[2], m.centred + 3 * first[0], q);
        subtract(m.centred + 3 * first[3], m.centred + 3 * first[0], r);
        cross(p, q, up);
        if (dot(up, r) > 0.0) {
            w.first_corners[1] = first[2];
            w.first_corners[2] = first[1];
        }
        int64_t alive = carom_hull(&w);
        if (alive < 0 || alive > sizes.triangles())
            return false;
        MergeWork& g = m.merge;
        g.points = m.centred;
        g.faces = w.faces;
        g.face_count = w.face_count;
        g.triangle_count = alive;
        g.point_count = sizes.count;
        g.thin = numbers.coplanar * size;
        g.parallel = numbers.parallel;
        g.tiny = numbers.tiny;
        carom_merge_faces(&g, LEAST_FACES);
        return true;
    }

    // The rank of each point among the corners on the grid, in Bullet's order.
    bool list(const Box& box, const double* step, const double* middle) {
        int64_t count = sizes.count, across = 2 * static_cast<int64_t>(numbers.grid);
        double per_step[3];
        for (int k = 0; k < 3; ++k)
            per_step[k] = 1.0 / step[k];
        for (int64_t n = 0; n < 3 * count; ++n)
            m.cells[n] = __builtin_trunc((points[n] - middle[n % 3]) * per_step[n % 3]);
        int axes[3];
        bool is_mirrored = choose_axes(box, axes);
        auto cell = [&](int64_t n, int axis) {
            int64_t value = static_cast<int64_t>(m.cells[3 * n + axes[axis]]);
            return is_mirrored ? -value : value;
        };
        for (int64_t n = 0; n < count; ++n) {
            m.keys[n] = (cell(n, 1) * across + cell(n, 0)) * across + cell(n, 2);
            m.order[n] = static_cast<int32_t>(n);
        }
        sort_by_key(m.keys, count, m.order, m.spare);
        int32_t distinct = 0, *places = m.point_of;
        for (int64_t i = 0; i < count; ++i) {
            int32_t n = m.order[i];
            if (i == 0 || m.keys[n] != m.keys[m.order[i - 1]]) {
                for (int axis = 0; axis < 3; ++axis)
                    m.sorted[3 * distinct + axis] = static_cast<int32_t>(cell(n, axis));
                ++distinct;
            }
            m.number[n] = distinct - 1;
            for (int32_t times = uses ? uses[n] : 1; times > 0; --times)
                *places++ = distinct - 1;
        }
        CornerWork& w = m.listing;
        w.points = m.sorted;
        w.point_of = m.point_of;
        w.count = distinct;
        w.total = sizes.total;
        w.most_spokes = sizes.spokes();
        int64_t listed = carom_corner_order(&w);
        if (listed < 0)
            return false;
        for (int32_t n = 0; n < distinct; ++n)
            m.firsts[n] = static_cast<int32_t>(listed);
        for (int64_t n = 0; n < listed; ++n)
            m.firsts[w.order[n]] = static_cast<int32_t>(n);
        for (int64_t n = 0; n < count; ++n)
            m.rank[n] = m.firsts[m.number[n]];
        return true;
    }

    // The axes along which the extent is neither the greatest nor the least, the greatest, the least; whether they
    // are left-handed in this order.
    static bool choose_axes(const Box& box, int* axes) {
        double x = box.high[0] - box.low[0], y = box.high[1] - box.low[1], z = box.high[2] - box.low[2];
        int greatest = x < y ? (y < z ? 2 : 1) : (x < z ? 2 : 0);
        int least = x < y ? (x < z ? 0 : 2) : (y < z ? 1 : 2);
        if (least == greatest)
            least = (greatest + 1) % 3;
        axes[0] = 3 - greatest - least;
        axes[1] = greatest;
        axes[2] = least;
        return (axes[0] + 1) % 3 != axes[1];
    }

    // The corners that faces use, by rank, as they are on the grid; and the faces' indices of these.
    void arrange(const double* step, const double* middle) {
        int64_t corner_count = 0, used = 0;
        for (int64_t n = 0; n < m.merge.loop_count; ++n)
            corner_count += m.counts[n];
        for (int64_t n = 0; n < sizes.count; ++n)
            m.place[n] = -1;
        for (int64_t n = 0; n < corner_count; ++n)
            m.place[m.corners[n]] = 0;
        for (int64_t n = 0; n < sizes.count; ++n)
            if (m.place[n] == 0)
                m.order[used++] = static_cast<int32_t>(n);
        sort_by_key(m.rank, used, m.order, m.spare);
        for (int64_t n = 0; n < used; ++n) {
            int32_t point = m.order[n];
            m.place[point] = static_cast<int32_t>(n);
            for (int k = 0; k < 3; ++k)
                m.vertices[3 * n + k] = m.cells[3 * point + k] * step[k] + middle[k];
        }
        for (int64_t n = 0; n < corner_count; ++n)
            m.corners[n] = m.place[m.corners[n]];
        results[0] = used;
        results[1] = corner_count;
        results[2] = m.merge.loop_count;
    }
};

}  // namespace

// Finds corners to begin a hull with; writes up to four indices, returns how many.
extern "C" CAROM_EXPORT int64_t
carom_first_corners(const double* points, int64_t count, const double* thin, int32_t* corners) {
    return first_corners(points, count, *thin, corners);
}

// How many bytes `carom_gridded_hull` needs for these sizes.
extern "C" CAROM_EXPORT int64_t carom_gridded_bytes(const int64_t* sizes) {
    Room room{nullptr};
    Memory memory(room, Sizes{sizes[0], sizes[1], sizes[2], sizes[3]});
    return room.used;
}

// Makes a hull of points; `sizes` are their number, that of their uses, the most vertices, and a factor on room for
// what vanishes on the way. Returns 0, 1 if there is not enough room, 2 if Python has to look at the points. Results
// are where vertices, corners of faces, and numbers of corners are in the memory, and how many there are.
extern "C" CAROM_EXPORT int64_t carom_gridded_hull(
    const double* points,
    const int32_t* uses,
    const int64_t* sizes,
    const double* numbers,
    char* memory,
    int64_t* results
) {
    Room room{memory};
    Sizes own{sizes[0], sizes[1], sizes[2], sizes[3]};
    Memory arrays(room, own);
    const Numbers& values = *reinterpret_cast<const Numbers*>(numbers);
    GriddedHull hull{points, uses, own, values, arrays};
    Outcome outcome = hull.make();
    const void* places[] = {arrays.vertices, arrays.corners, arrays.counts};
    for (int k = 0; k < 3; ++k) {
        results[2 * k] = static_cast<const char*>(places[k]) - memory;
        results[2 * k + 1] = hull.results[k];
    }
    return outcome;
}
