// The corners of a convex hull in the order in which Bullet lists them: `carom.geometry.corner_order`.
//
// That order depends on how the hull was put together. Bullet sorts the points on its grid, halves them again and
// again, and joins hulls; each corner remembers one of its edges, its *lead*, and the list of corners follows the
// edges, from the leads on. So the same halves are joined here, with whole numbers throughout. A *spoke* is an edge
// as seen from one of its corners; spokes 2 k and 2 k + 1 are one edge. Those of a corner form a ring,
// counter-clockwise from outside. Faces are polygons: coplanar points share one, and no corner is in the middle
// of an edge. So hulls of the same points have the same edges, however they were made; only leads differ.

#include "export.h"
#include "layouts.h"

namespace {

struct Vector {
    int64_t x, y, z;
};

Vector operator-(Vector a, Vector b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
Vector cross(Vector a, Vector b) { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }
int64_t dot(Vector a, Vector b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
bool is_zero(Vector a) { return a.x == 0 && a.y == 0 && a.z == 0; }

// The lowest and the highest corner of what is seen along z.
struct Ends {
    int32_t bottom, top;
};

// Along the right or left side of what is seen along z, from bottom to top: the corner above and below each.
struct Outline {
    int32_t *up, *down;
    int64_t sign;  // of a turn to the inside on the way up
};

// An edge between two hulls. Where the next one is at another corner of a hull: the spoke by which the rim goes on
// from here, and that by which it comes there; -1 otherwise.
struct Bridge {
    int32_t corner[2], leaves[2], comes[2];
};

enum Side { LOWER, UPPER };

struct Builder {
    CornerWork& w;
    int64_t spokes = 0;
    bool is_full = false;

    Vector at(int32_t corner) const {
        const int32_t* p = w.points + 3 * corner;
        return {p[0], p[1], p[2]};
    }
    Vector along(int32_t spoke) const { return at(w.far[spoke]) - at(w.far[spoke ^ 1]); }
    Outline outline(int side) const {
        int32_t* first = w.outline + 2 * side * w.count;
        return {first, first + w.count, side == 0 ? 1 : -1};
    }

    // The next spoke towards the side on which a hull's rim is cut open, or away from it.
    int32_t next(int side, int32_t spoke) const { return (side == UPPER ? w.after : w.before)[spoke]; }
    int32_t last(int side, int32_t spoke) const { return (side == UPPER ? w.before : w.after)[spoke]; }
    void link(int side, int32_t a, int32_t b) {
        (side == UPPER ? w.after : w.before)[a] = b;
        (side == UPPER ? w.before : w.after)[b] = a;
    }

    // Take an edge out of both rings; whatever the leads were, they are now what followed it.
    void drop(int32_t spoke) {
        for (int32_t end = spoke & ~1; end <= (spoke | 1); ++end) {
            int32_t corner = w.far[end ^ 1], following = w.after[end];
            w.lead[corner] = following == end ? -1 : following;
            if (following != end)
                link(UPPER, w.before[end], following);
        }
    }

    Ends build(int64_t begin, int64_t end) {
        int32_t first = w.point_of[begin];
        if (first == w.point_of[end - 1])
            return {first, first};
        int64_t middle = begin + (end - begin) / 2, upper = middle;
        while (upper < end && w.point_of[upper] == w.point_of[middle - 1])
            ++upper;
        Ends a = build(begin, middle);
        return upper == end ? a : joined(a, build(upper, end));
    }

    Ends joined(Ends a, Ends b) {
        if (is_full)
            return a;
        Outline right = outline(0), left = outline(1);
        int32_t p = a.top, q = b.bottom, r = q, l = q;
        if (at(p).x == at(q).x && at(p).y == at(q).y) {
            // One above the other: only the lower one is in the outline.
            r = right.up[q], l = left.up[q];
            if (r < 0) {
                wrap(p, w.lead[q] < 0 ? q : w.far[w.lead[q]]);
                return a;
            }
            right.down[r] = left.down[l] = -1;
        }
        int32_t c = p;
        bridge(c, l, left);
        left.up[c] = l, left.down[l] = c;
        bridge(p, r, right);
        right.up[p] = r, right.down[r] = p;
        // Of what is in the upright plane through this bridge the lowest edge is one of the hull.
        Vector s = at(r) - at(p), normal = {s.y, -s.x, 0};
        int32_t corner[2] = {p, r}, leaves[2] = {-1, -1};
        for (int side = LOWER; side <= UPPER; ++side) {
            int32_t lead = w.lead[corner[side]], spoke = lead;
            if (lead >= 0)
                do {
                    Vector t = along(spoke);
                    if (dot(t, normal) == 0 && dot(cross(t, s), normal) > 0)
                        leaves[side] = outer(side, leaves[side], spoke, normal);
                    spoke = w.after[spoke];
                } while (spoke != lead);
        }
        int32_t comes[2];
        cross_face(corner, leaves, comes, normal);
        wrap(corner[LOWER], corner[UPPER]);
        return {a.bottom, b.top};
    }

    // From the ends that face each other to the tangent that has both outlines on its inner side.
    void bridge(int32_t& p, int32_t& q, Outline o) const {
        for (;;) {
            if (o.down[p] >= 0 && o.sign * turn(o.down[p], p, q) <= 0)
                p = o.down[p];
            else if (o.up[q] >= 0 && o.sign * turn(p, q, o.up[q]) <= 0)
                q = o.up[q];
            else
                return;
        }
    }

    int64_t turn(int32_t a, int32_t b, int32_t c) const {
        Vector u = at(b) - at(a), v = at(c) - at(a);
        return u.x * v.y - u.y * v.x;
    }

    // Of two spokes of a corner in one face that one at the rim of the joined face.
    int32_t outer(int side, int32_t known, int32_t spoke, Vector normal) const {
        if (known < 0)
            return spoke;
        int64_t sense = dot(cross(along(known), along(spoke)), normal);
        return (side == UPPER ? sense > 0 : sense < 0) ? spoke : known;
    }

    // From one bridge to that at the other end of the face with this normal, along both hulls' rims. `comes` are the
    // spokes by which the rims reach the new corners; -1 for a corner that stays.
    void cross_face(int32_t* corner, const int32_t* leaves, int32_t* comes, Vector normal) const {
        comes[LOWER] = comes[UPPER] = -1;
        const int32_t from[2] = {corner[LOWER], corner[UPPER]};
        for (bool moved = true; moved;) {
            moved = false;
            for (int side = LOWER; side <= UPPER && !moved; ++side) {
                if (leaves[side] < 0)
                    continue;
                int32_t onwards, back;
                around(side, from[side], leaves[side], comes[side], normal, onwards, back);
                for (int32_t way = 0; way < 2 && !moved; ++way) {
                    int32_t spoke = way == 0 ? onwards : back;
                    int32_t other = spoke < 0 ? from[side] : w.far[spoke];
                    if (other != corner[side] && is_farther(corner, side, other, normal)) {
                        corner[side] = other;
                        comes[side] = spoke;
                        moved = true;
                    }
                }
            }
        }
    }

    // The spokes that reach the corners after and before one of a face, where there are such; -1 for the first corner.
    void around(
        int side, int32_t from, int32_t leaves, int32_t comes, Vector normal, int32_t& onwards, int32_t& back
    ) const {
        auto is_in_face = [&](int32_t spoke) { return dot(at(w.far[spoke]) - at(from), normal) == 0; };
        onwards = back = comes;
        if (comes < 0) {
            onwards = leaves;
            int32_t other = last(side, leaves);
            if (other != leaves && is_in_face(other))
                back = last(side, other ^ 1) ^ 1;
        } else {
            int32_t following = next(side, comes ^ 1);
            if (is_in_face(following))
                onwards = w.far[following] == from ? -1 : following;
            back = comes == leaves ? -1 : last(side, comes) ^ 1;
        }
    }

    // Whether a bridge should end at another corner: one beyond it, or farther away along it.
    bool is_farther(const int32_t* corner, int side, int32_t other, Vector normal) const {
        Vector s = at(corner[UPPER]) - at(corner[LOWER]), t = at(other) - at(corner[side]);
        int64_t beyond = dot(cross(s, t), normal), along = dot(s, t);
        return beyond < 0 || (beyond == 0 && (side == UPPER ? along > 0 : along < 0));
    }

    // Join two hulls by the edges between them, starting from one of these, below all others on the right.
    void wrap(int32_t a, int32_t b) {
        const int32_t first[2] = {a, b};
        Bridge* bridges = reinterpret_cast<Bridge*>(w.bridges);
        int32_t corner[2] = {a, b};
        int64_t made = 0;
        do {
            if (spokes + 2 * (made + 1) > w.most_spokes) {
                is_full = true;
                return;
            }
            Bridge& it = bridges[made++];
            Vector normal = {0, 0, 0};
            it = {{corner[LOWER], corner[UPPER]}, {-1, -1}, {-1, -1}};
            find_face(it, normal);
            if (is_zero(normal))
                break;  // All points are on one line.
            cross_face(corner, it.leaves, it.comes, normal);
        } while (corner[LOWER] != first[LOWER] || corner[UPPER] != first[UPPER]);
        tie(bridges, made);
    }

    // The spokes of a bridge's ends that are in the next face: nothing is beyond its plane.
    void find_face(Bridge& it, Vector& normal) const {
        Vector s = at(it.corner[UPPER]) - at(it.corner[LOWER]);
        for (int side = LOWER; side <= UPPER; ++side) {
            int32_t lead = w.lead[it.corner[side]], spoke = lead;
            if (lead < 0)
                continue;
            do {
                Vector t = along(spoke);
                int64_t height = dot(normal, t);
                if (height >= 0) {
                    // Most are below the plane found so far.
                    Vector plane = cross(t, s);
                    if (!is_zero(plane) && (is_zero(normal) || height > 0)) {
                        normal = plane;
                        it.leaves[LOWER] = it.leaves[UPPER] = -1;
                        it.leaves[side] = spoke;
                    } else if (!is_zero(plane)) {
                        it.leaves[side] = outer(side, it.leaves[side], spoke, normal);
                    }
                }
                spoke = w.after[spoke];
            } while (spoke != lead);
        }
    }

    // Put the bridges into the rings and take out what they cover, in the order in which they were found.
    void tie(const Bridge* bridges, int64_t made) {
        const int32_t base = static_cast<int32_t>(spokes);
        int64_t since[2] = {0, 0};      // the first bridge at the present corner of each side
        int32_t back[2] = {-1, -1};     // the spoke back to the corner before
        int32_t opening[2] = {-1, -1};  // the first spoke after which the start's old ones are covered
        spokes += 2 * made;
        for (int64_t n = 0; n < made; ++n) {
            for (int side = LOWER; side <= UPPER; ++side)
                w.far[base + 2 * n + side] = bridges[n].corner[1 - side];
            for (int side = UPPER; side >= LOWER; --side) {
                if (bridges[n].comes[side] < 0)
                    continue;
                int32_t leaves = bridges[n].leaves[side], behind = back[side];
                if (behind < 0) {
                    behind = last(side, leaves);
                    opening[side] = base + 2 * static_cast<int32_t>(since[side]) + side;
                } else {
                    cover(side, behind, leaves);
                }
                insert(side, behind, base + side, since[side], n + 1, leaves);
                since[side] = n + 1;
                back[side] = bridges[n].comes[side] ^ 1;
            }
        }
        for (int side = LOWER; side <= UPPER; ++side) {
            int32_t newest = base + 2 * static_cast<int32_t>(made - 1) + side;
            if (back[side] < 0) {
                // A hull of which only this corner is left: its ring is that of the bridges alone.
                insert(side, newest, base + side, 0, made - 1, newest);
                w.lead[bridges[0].corner[side]] = newest;
            } else {
                cover(side, back[side], opening[side]);
                insert(side, back[side], base + side, since[side], made, opening[side]);
            }
        }
    }

    void cover(int side, int32_t from, int32_t to) {
        for (int32_t spoke = next(side, from); spoke != to;) {
            int32_t following = next(side, spoke);
            drop(spoke);
            spoke = following;
        }
    }

    // Link a spoke, those of some bridges, and another one.
    void insert(int side, int32_t from, int32_t first, int64_t begin, int64_t end, int32_t to) {
        for (int64_t n = begin; n < end; ++n) {
            int32_t spoke = first + 2 * static_cast<int32_t>(n);
            link(side, from, spoke);
            from = spoke;
        }
        link(side, from, to);
    }
};

}  // namespace

// List the corners of the hull of points; returns how many there are, or -1 if there is not enough room for spokes.
extern "C" CAROM_EXPORT int64_t carom_corner_order(CornerWork* work) {
    CornerWork& w = *work;
    for (int64_t n = 0; n < w.count; ++n)
        w.lead[n] = -1, w.seen[n] = 0;
    for (int64_t n = 0; n < 4 * w.count; ++n)
        w.outline[n] = -1;
    Builder builder{w};
    builder.build(0, w.total);
    if (builder.is_full)
        return -1;
    // The first is the least in x, then y, then z; the others follow in breadth.
    int32_t first = 0;
    for (int32_t n = 1; n < w.count; ++n) {
        // Those that come later have a greater y, or z, at the same x.
        if (w.points[3 * n] < w.points[3 * first])
            first = n;
    }
    int64_t listed = 0;
    w.order[listed++] = first;
    w.seen[first] = 1;
    for (int64_t n = 0; n < listed; ++n) {
        int32_t lead = w.lead[w.order[n]], spoke = lead;
        if (lead < 0)
            continue;
        do {
            int32_t corner = w.far[spoke];
            if (!w.seen[corner]) {
                w.seen[corner] = 1;
                w.order[listed++] = corner;
            }
            spoke = w.after[spoke];
        } while (spoke != lead);
    }
    return listed;
}
