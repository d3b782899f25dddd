// Nearest points and overlaps: quick calls that use the current bounds and distances of shapes.

#include "export.h"
#include "rows.h"

namespace {

// Larger numbers are left to Python, which lets other threads run meanwhile.
enum { MAX_SHAPES = 256, MAX_PAIRS = 64 };

// Copies numbers; returns whether any bit has changed.
bool copy(double* to, const double* from, int64_t count) {
    uint64_t differences = 0;
    for (int64_t i = 0; i < count; ++i) {
        uint64_t bits[2];
        __builtin_memcpy(&bits[0], &to[i], sizeof(double));
        __builtin_memcpy(&bits[1], &from[i], sizeof(double));
        differences |= bits[0] ^ bits[1];
        to[i] = from[i];
    }
    return differences != 0;
}

// Places shapes at the current coordinates; false if data for this are missing.
bool place(Placement& at) {
    if (!at.place.function || at.shape_count > MAX_SHAPES)
        return false;
    PyObject* value = python.PyObject_GetAttr(at.shapes, at.changes_name);
    double changes = -1.0;
    const bool well = value && read_integer(value, &changes);
    release(value);
    if (!well)
        return false;
    const bool moved = copy(at.placed_at, at.positions, at.position_count);
    if (moved || *at.readiness < contacts::PLACED || at.changes != changes) {
        // After a step these are the poses at the start of its last substep, which other functions have to return.
        copy(at.poses_before, at.poses, at.pose_count);
        run(at.find_poses);
        run(at.place);
        copy(at.poses, at.poses_before, at.pose_count);
        at.changes = static_cast<int64_t>(changes);
    }
    return true;
}

struct Range {
    int64_t begin, end;
};

// Rows of one link, or of all links of a body.
Range rows_of(const Body& body, double link) {
    const int64_t first = body.first_link, end = first + 1 + body.link_count;
    if (link <= queries::ANY_LINK)
        return {first, end};
    const int64_t row = first + 1 + static_cast<int64_t>(link);
    return row < end ? Range{row, row + 1} : Range{first, first};
}

struct Pair {
    int32_t shape_a, shape_b, link_a, link_b;
};

// Whether Bullet comes across a pair of shapes before another one of the same two links: the highest level of
// their trees at which the pairs differ decides, and there the second shape before the first.
bool is_found_first(const Placement& at, const Pair& pair, const Pair& other) {
    const int32_t a = at.path[pair.shape_a], other_a = at.path[other.shape_a];
    const int32_t b = at.path[pair.shape_b], other_b = at.path[other.shape_b];
    const int32_t in_a = a ^ other_a, in_b = b ^ other_b;
    if (!in_b || (in_b < in_a && in_b < (in_a ^ in_b)))
        return a > other_a;
    return b > other_b;
}

// All pairs of a shape of links a and a shape of links b; -1 if there are too many.
int find_pairs(const Placement& at, Range a, Range b, Pair* pairs) {
    int count = 0;
    for (int64_t i = a.begin; i < a.end; ++i)
        for (int64_t k = b.begin; k < b.end; ++k) {
            const int first = count;
            for (int32_t m = 0; m < at.link_shapes[i]; ++m)
                for (int32_t n = 0; n < at.link_shapes[k]; ++n) {
                    if (count == MAX_PAIRS)
                        return -1;
                    const int32_t link_a = static_cast<int32_t>(i - a.begin),
                                  link_b = static_cast<int32_t>(k - b.begin);
                    const Pair pair = {at.first_shape[i] + m, at.first_shape[k] + n, link_a, link_b};
                    int place = count++;
                    for (; place > first && is_found_first(at, pair, pairs[place - 1]); --place)
                        pairs[place] = pairs[place - 1];
                    pairs[place] = pair;
                }
        }
    return count;
}

Contact contact(int32_t body_a, int32_t body_b, int32_t link_a, int32_t link_b, const Candidate& found) {
    const Vector on_b = vector_at(found.point), normal = vector_at(found.normal), none = {0.0, 0.0, 0.0};
    const double d = found.distance;
    const Vector on_a = {on_b.x + d * normal.x, on_b.y + d * normal.y, on_b.z + d * normal.z};
    return {body_a, body_b, link_a, link_b, on_a, on_b, normal, none, none, d, 0.0, 0.0, 0.0};
}

// A link by its body's number and its own, -1 for the base.
struct Place {
    int32_t body, link;
    bool operator<(const Place& other) const { return body < other.body || (body == other.body && link < other.link); }
};

bool meets(const Placement& at, int64_t shape, const double* lower, const double* upper) {
    // The bounds of an absent body's shapes are empty.
    if (at.kind[shape] == codes::PLANE)
        return at.lower[3 * shape] <= at.upper[3 * shape];
    for (int axis = 0; axis < 3; ++axis)
        if (!(at.lower[3 * shape + axis] <= upper[axis] && at.upper[3 * shape + axis] >= lower[axis]))
            return false;
    return true;
}

}  // namespace

// Arguments: two bodies, distance, link of the first, link of the second, two collision shapes without bodies,
// connection.
extern "C" CAROM_EXPORT PyObject* carom_closest_points(const double* in, const Call* call) {
    Scene& scene = *call->client->scene;
    const PairSearch& nearest = scene.nearest;
    const Body *a = call->body, *b = find_body(*call->client, in[1]);
    Pair pairs[MAX_PAIRS];
    if (!b || in[5] >= 0.0 || in[6] >= 0.0 || !nearest.search.function || !place(scene.placement))
        return nullptr;
    const Range rows_a = rows_of(*a, in[3]), rows_b = rows_of(*b, in[4]);
    const int count = find_pairs(scene.placement, rows_a, rows_b, pairs);
    if (count < 0 || count > nearest.room)
        return nullptr;
    int32_t before[2][MAX_PAIRS];
    for (int i = 0; i < count; ++i) {
        before[0][i] = nearest.first[i], before[1][i] = nearest.second[i];
        nearest.first[i] = pairs[i].shape_a, nearest.second[i] = pairs[i].shape_b;
    }
    int found = 0, of[MAX_PAIRS];
    Candidate points[MAX_PAIRS];
    if (count) {
        const TemporaryValue<int32_t> asked(nearest.count, count);
        const TemporaryValue<double> reach(
            nearest.max_distance, in[2] < magnitudes::MAX_DISTANCE ? in[2] : magnitudes::MAX_DISTANCE
        );
        run(nearest.search);
        for (found = 0; found < *nearest.found; ++found) {
            of[found] = nearest.pairs[found];
            points[found] = nearest.points[found];
        }
    }
    for (int i = 0; i < count; ++i)
        nearest.first[i] = before[0][i], nearest.second[i] = before[1][i];
    const int first_a = static_cast<int>(rows_a.begin - a->first_link) - 1;
    const int first_b = static_cast<int>(rows_b.begin - b->first_link) - 1;
    // From here on the world may change: making a tuple can start garbage collection, which may run any code.
    Row contacts(found);
    for (int i = 0; contacts.tuple && i < found; ++i) {
        const Pair& pair = pairs[of[i]];
        const int body_a = static_cast<int>(in[0]), body_b = static_cast<int>(in[1]);
        contacts.add(tuple_of(contact(body_a, body_b, first_a + pair.link_a, first_b + pair.link_b, points[i])));
    }
    return contacts.tuple;
}

// Arguments: two corners of a box, connection.
extern "C" CAROM_EXPORT PyObject* carom_overlapping(const double* in, const Call* call) {
    Placement& at = call->client->scene->placement;
    if (at.has_bare_links || !place(at))
        return nullptr;
    Place places[MAX_SHAPES];
    int count = 0;
    for (int64_t shape = 0; shape < at.shape_count; ++shape) {
        if (!meets(at, shape, in, in + 3))
            continue;
        const int32_t row = at.link[shape];
        const Place found = {at.place_body[row], at.place_link[row]};
        int before = count;
        while (before && found < places[before - 1])
            --before;
        if (before && !(places[before - 1] < found))
            continue;
        for (int i = count++; i > before; --i)
            places[i] = places[i - 1];
        places[before] = found;
    }
    if (!count) {
        python.Py_IncRef(python.None);
        return python.None;
    }
    Row links(count);
    for (int i = 0; links.tuple && i < count; ++i) {
        Row link(2);
        link.add(places[i].body);
        link.add(places[i].link);
        links.add(link.tuple);
    }
    return links.tuple;
}
