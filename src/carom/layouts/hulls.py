"""Memory of the loops that make convex hulls of points; NumPy has it, and the library's C++ fills it."""

from carom.layouts.records import At, Double, Int32, Int64, Read, c_record


@c_record(plane=4, corners=3, neighbours=3)
class HullFace:
    """A triangle of a hull that grows.

    Attributes:
        plane: Outward unit normal and offset.
        height: Of the farthest point.
        corners: Counter-clockwise from outside.
        neighbours: The face across the edge from each corner to the next.
        first: The first of the points above it, a list by `HullWork.next`; -1 for none.
        last: The last one.
        farthest: The highest one.
        mark: The point from which it was looked at last.
        is_below: Whether it is seen from there.
        is_alive: Whether it is still a face.
    """

    plane: Double
    height: Double
    corners: Int32
    neighbours: Int32
    first: Int32
    last: Int32
    farthest: Int32
    mark: Int32
    is_below: Int32
    is_alive: Int32


@c_record()
class HullEdge:
    """An edge of the rim of what is seen, and the face beyond it."""

    start: Int32
    end: Int32
    beyond: Int32


@c_record()
class HullEntry:
    """An entry of the queue: the highest face first, of equal ones that with the lower number."""

    height: Double
    number: Int64


@c_record(first_corners=4)
class HullWork:
    """Memory of one hull that grows.

    Attributes:
        points: (count, 3).
        most_vertices: -1 for no limit.
        most_faces: Room for faces, also those that vanish.
        rounding: Height above a face up to which points count as on it [m].
        tolerance: Points outside by no more are left out [m].
        first_corners: Points that span a volume.
        faces: `most_faces`, as `queue`, `rim`, `loop` and `seen`.
        next: For each point the next one in its list.
        rim_at: For each point the place in the rim of the edge that starts there.
        rim_of: The mark of that rim.
        face_count: Result: rows of `faces` that were used.
    """

    points: Read[Double]
    count: Int64
    most_vertices: Int64
    most_faces: Int64
    rounding: Double
    tolerance: Double
    first_corners: Int32
    faces: At[HullFace]
    queue: At[HullEntry]
    rim: At[HullEdge]
    loop: At[HullEdge]
    seen: At[Int32]
    next: At[Int32]
    rim_at: At[Int32]
    rim_of: At[Int32]
    face_count: Int64


@c_record()
class MergeWork:
    """Joining of coplanar faces.

    Attributes:
        face_count: Rows of `faces`, also those that vanished.
        triangle_count: Faces that are left.
        thin: Distance from a plane up to which a vertex counts as in it [m].
        parallel: Least cosine between the normals of triangles that are joined.
        tiny: Least length that can be divided by.
        normals: (triangle_count, 3).
        areas: For each triangle, as `face`, `order`, `spare`, `group_of` and `group`.
        number: For each face which triangle it is.
        following: For each point, as `following_of` and `uses`.
        corners: Result, up to 3 for each triangle: the corners of all loops, one after the other.
        counts: Result, up to one for each triangle: how many corners each loop has.
        loop_count: Result.
    """

    points: Read[Double]
    faces: Read[HullFace]
    face_count: Int64
    triangle_count: Int64
    point_count: Int64
    thin: Double
    parallel: Double
    tiny: Double
    normals: At[Double]
    areas: At[Double]
    number: At[Int32]
    face: At[Int32]
    order: At[Int32]
    spare: At[Int32]
    group_of: At[Int32]
    group: At[Int32]
    following: At[Int32]
    following_of: At[Int32]
    uses: At[Int32]
    corners: At[Int32]
    counts: At[Int32]
    loop_count: Int64


@c_record()
class CornerWork:
    """Listing of a hull's corners in Bullet's order.

    Attributes:
        points: (count, 3): distinct, sorted by y, then x, then z.
        point_of: The point at each of `total` places, which may be there more than once.
        most_spokes: Room for spokes, also those that vanish.
        lead: A spoke of each corner, -1 for none.
        outline: (4, count): see `Outline`.
        seen: For each point.
        far: For each spoke the corner at its other end.
        after: The next one in its ring.
        before: The one before.
        bridges: (most_spokes / 2, 6): see `Bridge`.
        order: Result, up to one for each point.
    """

    points: Read[Int32]
    point_of: Read[Int32]
    count: Int64
    total: Int64
    most_spokes: Int64
    lead: At[Int32]
    outline: At[Int32]
    seen: At[Int32]
    far: At[Int32]
    after: At[Int32]
    before: At[Int32]
    bridges: At[Int32]
    order: At[Int32]
