// Convex hulls by quickhull: `carom.geometry.hull`. The caller provides all memory. Sums are in the order of their
// index, so that corners and their order are the same on every machine.

#include "export.h"
#include "layouts.h"

namespace {

using Face = HullFace;
using Edge = HullEdge;
using Entry = HullEntry;

}  // namespace

namespace {

double dot(const double* a, const double* b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

// The normal of a triangle, not of unit length, and its length.
double crossed(const double* p, const int32_t* corners, double* normal) {
    const double *a = p + 3 * corners[0], *b = p + 3 * corners[1], *c = p + 3 * corners[2];
    double u[3], v[3];
    for (int k = 0; k < 3; ++k) {
        u[k] = b[k] - a[k];
        v[k] = c[k] - a[k];
    }
    normal[0] = u[1] * v[2] - u[2] * v[1];
    normal[1] = u[2] * v[0] - u[0] * v[2];
    normal[2] = u[0] * v[1] - u[1] * v[0];
    return __builtin_sqrt(dot(normal, normal));
}

struct Hull {
    HullWork& w;
    int64_t queued = 0;
    int32_t mark = 0;

    const double* at(int32_t point) const { return w.points + 3 * point; }

    static bool before(const Entry& a, const Entry& b) {
        return a.height > b.height || (a.height == b.height && a.number < b.number);
    }

    void push(Entry entry) {
        int64_t place = queued++;
        while (place > 0 && before(entry, w.queue[(place - 1) / 2])) {
            w.queue[place] = w.queue[(place - 1) / 2];
            place = (place - 1) / 2;
        }
        w.queue[place] = entry;
    }

    Entry pop() {
        Entry top = w.queue[0], last = w.queue[--queued];
        int64_t place = 0;
        for (int64_t child; (child = 2 * place + 1) < queued; place = child) {
            if (child + 1 < queued && before(w.queue[child + 1], w.queue[child]))
                ++child;
            if (!before(w.queue[child], last))
                break;
            w.queue[place] = w.queue[child];
        }
        w.queue[place] = last;
        return top;
    }

    double height(const Face& face, int32_t point) const { return dot(at(point), face.plane) - face.plane[3]; }

    // Find the farthest point of a face and put the face in the queue.
    void rank(int32_t number) {
        Face& face = w.faces[number];
        if (face.first < 0)
            return;
        face.farthest = face.first;
        face.height = height(face, face.first);
        for (int32_t point = w.next[face.first]; point >= 0; point = w.next[point]) {
            double here = height(face, point);
            if (here > face.height) {
                face.height = here;
                face.farthest = point;
            }
        }
        push({face.height, number});
    }

    void add_face(int32_t a, int32_t b, int32_t c) {
        Face& face = w.faces[w.face_count++];
        face.corners[0] = a;
        face.corners[1] = b;
        face.corners[2] = c;
        face.first = face.last = face.farthest = -1;
        face.mark = 0;
        face.is_alive = 1;
        double length = crossed(w.points, face.corners, face.plane), middle[3];
        for (int k = 0; k < 3; ++k) {
            face.plane[k] = length > 0.0 ? face.plane[k] / length : 0.0;
            middle[k] = (at(a)[k] + at(b)[k] + at(c)[k]) / 3.0;
        }
        face.plane[3] = dot(face.plane, middle);
    }

    // Give a point to the highest of the faces from `first` on that it is above, if there is one.
    void give(int32_t point, int64_t first) {
        int64_t owner = first;
        double highest = height(w.faces[first], point);
        for (int64_t number = first + 1; number < w.face_count; ++number) {
            double here = height(w.faces[number], point);
            if (here > highest) {
                highest = here;
                owner = number;
            }
        }
        if (!(highest > w.rounding))
            return;
        Face& face = w.faces[owner];
        w.next[point] = -1;
        if (face.first < 0)
            face.first = point;
        else
            w.next[face.last] = point;
        face.last = point;
    }

    void begin() {
        const int32_t* c = w.first_corners;
        w.face_count = 0;
        add_face(c[0], c[1], c[2]);
        add_face(c[0], c[2], c[3]);
        add_face(c[2], c[1], c[3]);
        add_face(c[1], c[0], c[3]);
        for (int32_t point = 0; point < w.count; ++point)
            give(point, 0);
        for (int n = 0; n < 4; ++n) {
            for (int i = 0; i < 3; ++i)
                for (int m = 0; m < 4; ++m)
                    for (int j = 0; j < 3; ++j)
                        if (w.faces[m].corners[j] == w.faces[n].corners[(i + 1) % 3] &&
                            w.faces[m].corners[(j + 1) % 3] == w.faces[n].corners[i])
                            w.faces[n].neighbours[i] = m;
            rank(n);
        }
    }

    // Faces seen from a point, and the loop of edges around them; the length of the loop, or 0 if it is none.
    int64_t see(int32_t first, const double* eye, double grazing, int64_t& seen_count) {
        ++mark;
        int64_t rim_count = 0;
        seen_count = 0;
        w.seen[seen_count++] = first;
        w.faces[first].mark = mark;
        w.faces[first].is_below = 1;
        for (int64_t place = 0; place < seen_count; ++place) {
            const Face& face = w.faces[w.seen[place]];
            for (int i = 0; i < 3; ++i) {
                int32_t start = face.corners[i], end = face.corners[(i + 1) % 3], beyond = face.neighbours[i];
                Face& other = w.faces[beyond];
                if (other.mark != mark) {
                    const double* p = other.plane;
                    other.mark = mark;
                    other.is_below = p[0] * eye[0] + p[1] * eye[1] + p[2] * eye[2] - p[3] > grazing;
                    if (other.is_below)
                        w.seen[seen_count++] = beyond;
                }
                if (!other.is_below) {
                    if (w.rim_of[start] == mark)
                        return 0;
                    w.rim_of[start] = mark;
                    w.rim_at[start] = static_cast<int32_t>(rim_count);
                    w.rim[rim_count++] = {start, end, beyond};
                }
            }
        }
        if (rim_count < 3)
            return 0;
        int32_t start = w.rim[0].start;
        int64_t length = 0;
        do {
            if (w.rim_of[start] != mark || length == rim_count)
                return 0;
            w.loop[length++] = w.rim[w.rim_at[start]];
            start = w.loop[length - 1].end;
        } while (start != w.rim[0].start);
        return length == rim_count ? length : 0;
    }

    // Add a face's farthest point: replace the faces that are seen from it. 1 if this was possible despite rounding
    // errors, 0 if not, -1 if there is no room.
    int take_in(int32_t number) {
        int32_t eye = w.faces[number].farthest;
        int64_t seen_count, length = see(number, at(eye), w.rounding, seen_count);
        if (!length)
            length = see(number, at(eye), -w.rounding, seen_count);
        if (!length)
            return 0;
        if (w.face_count + length > w.most_faces)
            return -1;
        int64_t first = w.face_count;
        for (int64_t i = 0; i < length; ++i)
            add_face(w.loop[i].start, w.loop[i].end, eye);
        for (int64_t i = 0; i < seen_count; ++i) {
            Face& face = w.faces[w.seen[i]];
            face.is_alive = 0;
            for (int32_t point = face.first, following; point >= 0; point = following) {
                following = w.next[point];
                if (point != eye)
                    give(point, first);
            }
        }
        for (int64_t i = 0; i < length; ++i) {
            int32_t own = static_cast<int32_t>(first + i);
            Face &face = w.faces[own], &outer = w.faces[w.loop[i].beyond];
            face.neighbours[0] = w.loop[i].beyond;
            face.neighbours[1] = static_cast<int32_t>(first + (i + 1) % length);
            face.neighbours[2] = static_cast<int32_t>(first + (i + length - 1) % length);
            for (int k = 0; k < 3; ++k)
                if (outer.corners[k] == w.loop[i].end && outer.corners[(k + 1) % 3] == w.loop[i].start) {
                    outer.neighbours[k] = own;
                    break;
                }
            rank(own);
        }
        return 1;
    }

    // Drop a face's farthest point, which cannot be added because of rounding errors.
    void leave_out(int32_t number) {
        Face& face = w.faces[number];
        int32_t before = -1;
        for (int32_t point = face.first; point != face.farthest; point = w.next[point])
            before = point;
        int32_t after = w.next[face.farthest];
        (before < 0 ? face.first : w.next[before]) = after;
        if (face.last == face.farthest)
            face.last = before;
        rank(number);
    }

    bool grow() {
        int64_t left = w.most_vertices < 0 ? w.count : w.most_vertices - 4;
        double least = w.tolerance > w.rounding ? w.tolerance : w.rounding;
        while (left > 0 && queued) {
            Entry top = pop();
            if (top.height <= least)
                return true;
            int32_t number = static_cast<int32_t>(top.number);
            if (!w.faces[number].is_alive)
                continue;
            int taken = take_in(number);
            if (taken < 0)
                return false;
            if (taken)
                --left;
            else
                leave_out(number);
        }
        return true;
    }
};

struct Merge {
    MergeWork& w;
    int64_t corner_count = 0;

    const int32_t* corners(int32_t triangle) const { return w.faces[w.face[triangle]].corners; }
    int32_t neighbour(int32_t triangle, int i) const { return w.number[w.faces[w.face[triangle]].neighbours[i]]; }

    void begin() {
        int32_t count = 0;
        for (int64_t n = 0; n < w.face_count; ++n)
            if (w.faces[n].is_alive) {
                w.number[n] = count;
                w.face[count] = static_cast<int32_t>(n);
                double* normal = w.normals + 3 * count;
                double area = crossed(w.points, w.faces[n].corners, normal);
                w.areas[count] = area;
                for (int k = 0; k < 3; ++k)
                    normal[k] /= area > w.tiny ? area : w.tiny;
                w.order[count] = count;
                w.group_of[count] = -1;
                ++count;
            }
        // The largest first: their normals are the most accurate, and slivers join them. Merged runs keep the order.
        int32_t *from = w.order, *to = w.spare;
        for (int64_t run = 1; run < count; run *= 2) {
            for (int64_t low = 0; low < count; low += 2 * run) {
                int64_t middle = low + run < count ? low + run : count;
                int64_t high = low + 2 * run < count ? low + 2 * run : count;
                for (int64_t a = low, b = middle, out = low; out < high; ++out)
                    to[out] = a < middle && (b >= high || w.areas[from[a]] >= w.areas[from[b]]) ? from[a++] : from[b++];
            }
            int32_t* swapped = from;
            from = to;
            to = swapped;
        }
        if (from != w.order)
            for (int64_t i = 0; i < count; ++i)
                w.order[i] = from[i];
        for (int64_t p = 0; p < w.point_count; ++p) {
            w.following_of[p] = -1;
            w.uses[p] = 0;
        }
        w.loop_count = 0;
    }

    // Take the free triangles that are connected to a seed and lie in its plane.
    int64_t patch(int32_t seed) {
        const double *normal = w.normals + 3 * seed, *origin = w.points + 3 * corners(seed)[0];
        int64_t count = 0;
        w.group[count++] = seed;
        w.group_of[seed] = seed;
        for (int64_t place = 0; place < count; ++place)
            for (int i = 0; i < 3; ++i) {
                int32_t other = neighbour(w.group[place], i);
                if (w.group_of[other] >= 0)
                    continue;
                const int32_t *mine = corners(w.group[place]), *its = corners(other);
                int32_t apex = its[0];
                for (int k = 0; k < 3; ++k)
                    if (its[k] != mine[i] && its[k] != mine[(i + 1) % 3])
                        apex = its[k];
                const double* p = w.points + 3 * apex;
                double from[3] = {p[0] - origin[0], p[1] - origin[1], p[2] - origin[2]}, high = dot(from, normal);
                bool is_parallel = w.areas[other] <= w.thin * w.thin || dot(w.normals + 3 * other, normal) > w.parallel;
                if (is_parallel && (high < 0.0 ? -high : high) <= w.thin) {
                    w.group_of[other] = seed;
                    w.group[count++] = other;
                }
            }
        return count;
    }

    void put(const int32_t* loop, int64_t count) {
        for (int64_t i = 0; i < count; ++i)
            w.corners[corner_count++] = loop[i];
        w.counts[w.loop_count++] = static_cast<int32_t>(count);
    }

    // Put the loop around a group; whether it has one: there are no holes, and it does not touch itself.
    bool outline(int32_t seed, int64_t group_count) {
        int64_t count = 0;
        int32_t first = -1;
        for (int64_t place = 0; place < group_count; ++place)
            for (int i = 0; i < 3; ++i)
                if (w.group_of[neighbour(w.group[place], i)] != seed) {
                    int32_t start = corners(w.group[place])[i];
                    if (w.following_of[start] == seed)
                        return false;
                    w.following_of[start] = seed;
                    w.following[start] = corners(w.group[place])[(i + 1) % 3];
                    first = first < 0 || start < first ? start : first;
                    ++count;
                }
        int64_t length = 0;
        if (!count)
            return false;
        for (int32_t point = first;; point = w.following[point]) {
            if (length == count || w.following_of[point] != seed)
                return false;
            w.corners[corner_count + length++] = point;
            if (w.following[point] == first)
                break;
        }
        if (length != count)
            return false;
        corner_count += length;
        w.counts[w.loop_count++] = static_cast<int32_t>(length);
        return true;
    }

    // Leave out corners of only two faces: they lie on the edge between these.
    void drop_middles() {
        for (int64_t i = 0; i < corner_count; ++i)
            ++w.uses[w.corners[i]];
        int64_t read = 0, written = 0, loops = 0;
        for (int64_t n = 0; n < w.loop_count; ++n) {
            int64_t kept = 0;
            for (int32_t i = 0; i < w.counts[n]; ++i, ++read)
                if (w.uses[w.corners[read]] > 2)
                    w.corners[written + kept++] = w.corners[read];
            if (kept >= 3) {
                written += kept;
                w.counts[loops++] = static_cast<int32_t>(kept);
            }
        }
        w.loop_count = loops;
    }

    void run(int64_t least_faces) {
        begin();
        for (int64_t i = 0; i < w.triangle_count; ++i) {
            int32_t seed = w.order[i];
            if (w.group_of[seed] >= 0)
                continue;
            int64_t count = patch(seed);
            if (!outline(seed, count))
                for (int64_t place = 0; place < count; ++place)
                    put(corners(w.group[place]), 3);
        }
        drop_middles();
        if (w.loop_count >= least_faces)
            return;
        // A shape thinner than the tolerance would lose its faces.
        corner_count = w.loop_count = 0;
        for (int32_t n = 0; n < w.triangle_count; ++n)
            put(corners(n), 3);
    }
};

}  // namespace

// Grow a hull; returns how many faces are left, or -1 if there is not enough room for faces.
extern "C" CAROM_EXPORT int64_t carom_hull(HullWork* work) {
    Hull hull{*work};
    for (int64_t point = 0; point < work->count; ++point)
        work->rim_of[point] = 0;
    hull.begin();
    if (!hull.grow())
        return -1;
    int64_t alive = 0;
    for (int64_t n = 0; n < work->face_count; ++n)
        alive += work->faces[n].is_alive;
    return alive;
}

// Join the faces of a hull that lie in one plane, unless fewer than `least_faces` would be left.
extern "C" CAROM_EXPORT void carom_merge_faces(MergeWork* work, int64_t least_faces) { Merge{*work}.run(least_faces); }
