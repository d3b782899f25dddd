"""Data of collision detection and contacts: `Shapes`, `Pairs`, `Contacts`.

As in `layouts.model`, a field's axis is the first word of its name. A *manifold* is at most four contacts
of the same two shapes, in contiguous rows; manifolds are sorted by the lower, then by the higher shape row.
"""

from carom.layouts.types import (
    Index2,
    Index2Rows,
    Index4Rows,
    Int32,
    IntRows,
    Ints,
    Matrix3Rows,
    RealRows,
    Reals,
    Rows,
    Transforms,
    Vector3,
    Vector3Rows,
    Vector4Rows,
    Vectors3,
    Vectors4,
    parameter,
    real,
    state,
    struct,
)

MARGIN = 0.001
"""Collision margin of shapes made from files [m]."""

# Columns of `Pairs.count_pairs`.
PAIRS, LEAVES, BOUNDED, PLANES, READINESS, LEAF_LENGTH = 0, 1, 2, 3, 4, 5
START_CONTACTS, START_OVERLAPS, START_KNOWN = 6, 7, 8
LISTED, LIST_AGE, LIST_KIND, LIST_FILTER = 9, 10, 11, 12
START_RESETS_SEEN = 13
COLUMNS = 14
# The neighbour list: number of its pairs; substeps since it was made; its kind; `NO_LIST`, or one more than
# `Settings.filter_both` was.
NO_LIST = 0
# Up to this many shapes of a world are compared without a hierarchy: sorting them would not pay.
FEW_SHAPES = 32
# Value of START_CONTACTS and START_OVERLAPS, the numbers of contacts and of overlaps at the start of a step,
# until these have been saved.
NONE_KEPT = -1
# READINESS says which data of shapes are up to date between steps: none; poses and bounds; these and the
# hierarchy.
STALE, PLACED, IN_HIERARCHY = 0, 1, 2
# Number of buckets of the radix sort along the space-filling curve.
RADIX = 256
# Columns of `Contacts.count_contacts`: numbers of contacts, of overlaps, and of shapes whose overlaps
# have been looked for; length of `overlap_sorted` plus one, at most 0 if it has to be made anew; number of
# resets of trees so far (`State.tree_reset`), and those of them before the last substep.
THERE, OVERLAPS, KNOWN, SORTED, RESETS, RESETS_SEEN = 0, 1, 2, 3, 4, 5
# The columns with the numbers of rows of `Contacts`, by their axes.
COUNTED = {"contact": THERE, "overlap": OVERLAPS}
CONTACT_COLUMNS = 6
# Resets are counted from 0 again after so many, and never beyond the second number.
MANY_RESETS, MAX_RESETS = 2**30, 2**31 - 1
# Place among manifolds of overlaps without a manifold.
NO_MANIFOLD = -1
# Breaking distance of manifolds that an older file tells nothing about: that of their shapes.
AS_SHAPES = -1.0
# Processing threshold of such manifolds: that of their shapes.
AS_LINKS = -1e30
# How near two shapes are: far; close, so that Bullet takes their bounds for overlapping, without and with a
# manifold; so near that their contacts are looked for.
FAR, CLOSE, CLOSE_WITH_MANIFOLD, MEETING = -1, 0, 1, 2
# Value of `Contacts.contact_warm_start` for contacts whose manifold held in the last step; others have at
# most 1.
HOLDING = 2.0
# Value for contacts that held until a body was moved; it counts on as 0 does.
HELD_BEFORE = 0.5
# Maximum number of vertices of EPA's polytope, as in Bullet; it has up to twice as many faces.
MAX_CORNERS = 128


@struct
class Shapes:
    """Geometry and surfaces of the collision shapes, and with which links these collide.

    As in `Model`, fields with a leading world axis may differ between worlds. Of the geometry these are the
    sizes of balls, boxes, capsules and cylinders, and what follows from them: `scene.dynamics.sizes`.
    """

    shape_link: Ints = parameter("shape")
    shape_tree: Ints = parameter("shape")
    shape_kind: Ints = parameter("shape")
    shape_size: Vector3Rows = parameter("shape")  # see `codes.ShapeKind`
    shape_pose: Transforms = parameter("shape")  # in the link's inertial frame
    shape_part: Ints = parameter("shape")  # see `codes.Part`
    shape_depth: Ints = parameter("shape")  # in so many compounds, one in the other, Bullet has it
    # where it is in the tree of its compound, see `model.placed_pieces`
    shape_path: IntRows = parameter("shape")
    shape_margin: RealRows = parameter("shape")
    shape_breaking: RealRows = parameter("shape")  # breaking distance of contacts [m]
    shape_ccd_radius: Reals = parameter("shape")  # of the swept sphere of continuous detection [m]
    shape_first_vertex: Ints = parameter("shape")
    shape_vertex_count: Ints = parameter("shape")
    shape_first_face: Ints = parameter("shape")
    shape_face_count: Ints = parameter("shape")
    # of the bounds in the shape frame; of hulls, triangle meshes, height fields
    shape_center: Vectors3 = parameter("shape")
    shape_columns: Ints = parameter("shape")  # of height fields: points in one row
    # of triangle meshes: first node of the hierarchy, see `triangle_hierarchy`
    shape_first_node: Ints = parameter("shape")
    shape_leaf_count: Ints = parameter("shape")  # leaves of that hierarchy; a power of two

    # Surfaces: those of the link, or of the shape's own.
    shape_lateral_friction: RealRows = parameter("shape")
    shape_rolling_friction: RealRows = parameter("shape")
    shape_spinning_friction: RealRows = parameter("shape")
    shape_restitution: RealRows = parameter("shape")
    shape_stiffness: RealRows = parameter("shape")  # negative: rigid
    shape_contact_damping: RealRows = parameter("shape")
    shape_friction_anchor: IntRows = parameter("shape")
    # how it is combined, see `kernels.contact.ranked_friction`; 0: as in PyBullet
    shape_friction_rank: IntRows = parameter("shape")
    shape_friction_dimensions: IntRows = parameter("shape")  # see there; 0: not stated
    # factors on friction along the axes of the link's inertial frame
    shape_anisotropy: Vector3Rows = parameter("shape")
    # of new manifolds; see `overlap_solved_up_to` [m]
    shape_processing_threshold: RealRows = parameter("shape")
    # Of contacts that yield as MuJoCo's, see `kernels.dynamics.contact_compliance`.
    shape_reference: Vector4Rows = parameter("shape")
    shape_impedance: Vector4Rows = parameter("shape")
    # weight among two shapes, margin [m], and share of pyramids
    shape_mixing: Vector3Rows = parameter("shape")
    # How fast the surface moves in the shape, as a belt does, in the shape frame and about its origin.
    shape_surface_velocity: Vector3Rows = parameter("shape")
    shape_surface_spin: Vector3Rows = parameter("shape")

    # Polyhedra: vertices in the shape frame; faces with their outward planes (n, d), n · x = d, and
    # their corners counter-clockwise as seen from outside. A triangle mesh's faces are its triangles.
    # The vertices of a height field are its grid points row by row, x fastest.
    # After the vertices of a hull `WITH_GRAPH` come rows with which vertices and faces are beside each other.
    vertex_position: Vectors3 = parameter("vertex")
    face_plane: Vectors4 = parameter("face")
    face_first_corner: Ints = parameter("face")  # row of `corner_vertex`
    face_corner_count: Ints = parameter("face")
    corner_vertex: Ints = parameter("corner")  # row of `vertex_position`
    node_lower: Vectors3 = parameter("node")  # bounds in the shape frame
    node_upper: Vectors3 = parameter("node")

    link_first_shape: Ints = parameter("link")
    link_shape_count: Ints = parameter("link")
    # Of links whose shapes are in a compound: bounds along the axes of the inertial frame, margins included.
    link_center: Vector3Rows = parameter("link")
    link_extents: Vector3Rows = parameter("link")  # half the size
    # Where Bullet has the shapes when it creates the link, in the inertial frame of the base: where the
    # link's own frame is at joint positions 0, as if it were the inertial frame.
    link_made_pose: Transforms = parameter("link")
    link_group: Ints = parameter("link")
    link_mask: Ints = parameter("link")
    link_self_collision: Ints = parameter("link")  # loading flags for self-collision
    link_node_friction: RealRows = parameter("link")  # lateral friction of the nodes of soft bodies
    # 1: a pair with the link may have rolling or spinning friction of its own
    link_pair_twists: Ints = parameter("link")
    # the greatest margin in `filter_impedance` of pairs with the link [m]
    link_pair_margin: Reals = parameter("link")

    # Pairs of links whose collisions users have switched on or off, sorted by both link rows.
    filter_link_a: Ints = parameter("filter")
    filter_link_b: Ints = parameter("filter")
    filter_enabled: Ints = parameter("filter")
    # Contacts of a pair that are as it states them: as `shape_reference`; bounds of the impedance, width and
    # margin, 0 for contacts as both shapes state them; lateral, rolling and spinning friction; time constant
    # and damping ratio of lateral friction, both 0 for those of the normal.
    filter_reference: Vectors4 = parameter("filter")
    filter_impedance: Vectors4 = parameter("filter")
    filter_friction: Vectors3 = parameter("filter")
    filter_lateral: Vectors4 = parameter("filter")


@struct
class Candidate:
    """Possible contact of a pair of shapes; at most four of them become contacts."""

    point: Vector3  # on shape b, in world axes
    normal: Vector3  # on shape b, towards a
    distance: real  # along the normal; negative: penetration
    on_face: Int32  # on a triangle: 1 if it is on the triangle's face, 0 if at an edge


@struct
class Overlap:
    """A row of the overlaps of `Contacts`."""

    pair: Index2
    place: Int32
    manifold: Int32
    breaking: real
    solved_up_to: real


@struct
class NewOverlap:
    """An overlap that is not among those of the last substep."""

    pair: Index2
    # When Bullet finds it, see `overlap_turns.turn_of`; then its place among all that it finds.
    turn: Int32
    wanted: Int32  # 1 if there is to be a manifold, else 0
    place: Int32  # as in `Overlap`
    manifold: Int32
    breaking: real
    solved_up_to: real


@struct
class Pairs:
    """Intermediate results of collision detection; lengths are in `engine.detection_capacity`."""

    shape_position: Vector3Rows  # of the shape frame, in world axes
    shape_frame: Matrix3Rows  # its rotation matrix
    # Bounds in world axes, without any threshold. The first part of a compound has those of its whole link
    # here, as they are in Bullet, and its own in `shape_part_lower` and `shape_part_upper`.
    shape_lower: Vector3Rows
    shape_upper: Vector3Rows
    shape_part_lower: Vector3Rows
    shape_part_upper: Vector3Rows
    shape_code: IntRows  # position along a space-filling curve
    shape_order: IntRows  # shapes sorted by this position, then the planes
    shape_sorted: IntRows  # workspace of the sort
    shape_motion: RealRows  # distance by which continuous detection looks ahead [m]
    shape_pair_end: IntRows  # end of the pairs with it as first shape; of the new overlaps that it finds
    # Shapes of trees that were reset since the last substep, in Bullet's order, and by shape its place there;
    # see `kernels.contact.resets`.
    shape_reset: IntRows
    shape_reset_place: IntRows  # -1: not reset
    # Bounds and look-ahead distances for which the neighbour list was made.
    shape_listed_lower: Vector3Rows
    shape_listed_upper: Vector3Rows
    shape_listed_motion: RealRows

    # Bounds of the hierarchy over `shape_order`; node 1 is the root, node n has the children 2n and 2n + 1.
    node_lower: Vector3Rows
    node_upper: Vector3Rows
    bucket_end: IntRows  # of a radix sort

    pair_shapes: Index2Rows  # the lower and the higher shape row; sorted
    pair_nearness: IntRows  # CLOSE, CLOSE_WITH_MANIFOLD or MEETING
    pair_breaking: RealRows  # breaking distance of its manifold, see `contact_margins` [m]
    # Neighbour list, see `kernels.contact.neighbour_list`: shapes as in `pair_shapes`.
    listed_shapes: Index2Rows
    listed_found: Index2Rows  # in the order in which they were found

    # Changes of the overlaps: entries are rows of old overlaps and, as -1 - row, of new ones.
    queue_entry: IntRows  # in the order of the pair cache
    queue_manifold: IntRows  # old ones in the order of manifolds
    queue_wanted: IntRows  # by old overlap: what becomes of it
    queue_new: Rows[NewOverlap]  # sorted by shapes
    queue_turn: IntRows  # new overlaps in the order in which they are found
    queue_merged: Rows[Overlap]  # old and new overlaps, sorted by shapes
    queue_start: Rows[Overlap]  # overlaps at the start of the step

    # Bullet's tree of bounds, see `kernels.contact.bounds_tree`: the shapes are its leaves.
    twig_lower: Vector3Rows
    twig_upper: Vector3Rows
    twig_links: Index4Rows  # parent, two children (-1: none), 0
    twig_stack: IntRows  # nodes still to be visited

    candidate: Rows[Candidate]
    polygon_a: Vector3Rows  # corners of touching faces
    polygon_b: Vector3Rows
    polygon_clipped: Vector3Rows
    polytope_point: Vector3Rows  # vertex: difference of a point of shape a and one of shape b
    polytope_point_a: Vector3Rows
    polytope_plane: Vector4Rows  # of a face: outward normal, distance from the origin
    polytope_face: Index4Rows  # its corners, and 1 if it is in use
    polytope_edge: Index4Rows  # edges of the hole to be closed with a new vertex

    # Saved contacts of the last substep, from which new contacts inherit: the first half has those at the
    # start of the step, the second half those of later substeps.
    previous_shapes: Index4Rows
    previous_normal: Vector3Rows
    previous_direction1: Vector3Rows
    previous_direction2: Vector3Rows
    previous_distance: RealRows
    previous_local_a: Vector3Rows
    previous_local_b: Vector3Rows
    previous_point_a: Vector3Rows
    previous_point_b: Vector3Rows
    previous_anchor_a: Vector3Rows
    previous_anchor_b: Vector3Rows
    previous_impulse: Vector3Rows
    previous_warm_start: RealRows
    previous_taken: IntRows  # 1: a new contact has been matched with it

    # Columns: PAIRS to LIST_FILTER, above.
    count_pairs: IntRows


@struct
class Contacts:
    """Contact points; they persist from step to step."""

    contact_shapes: Index4Rows = state("contact")  # shape a, shape b, link a, link b
    contact_local_a: Vector3Rows = state("contact")  # in the links' inertial frames
    contact_local_b: Vector3Rows = state("contact")
    # friction anchor, where it began to stick; in the links' inertial frames
    contact_anchor_a: Vector3Rows = state("contact")
    contact_anchor_b: Vector3Rows = state("contact")
    contact_point_a: Vector3Rows = state("contact")  # in world axes
    contact_point_b: Vector3Rows = state("contact")
    contact_normal: Vector3Rows = state("contact")  # on b, towards a
    contact_direction1: Vector3Rows = state("contact")  # friction directions
    contact_direction2: Vector3Rows = state("contact")
    contact_distance: RealRows = state("contact")  # negative: penetration
    contact_impulse: Vector3Rows = state("contact")  # of the last substep: normal, along directions 1 and 2
    # counter of warm starting, see `warm_starting.next_warm_start`
    contact_warm_start: RealRows = state("contact")
    # Pairs of shapes whose bounds overlap, with places in two orders; see `kernels.contact.overlaps`.
    overlap_shapes: Index2Rows = state("overlap")  # the lower and the higher shape row; sorted
    overlap_place: IntRows = state("overlap")  # in the pair cache
    overlap_manifold: IntRows = state("overlap")  # place among manifolds, or NO_MANIFOLD
    # breaking distance with which the manifold was made, or AS_SHAPES [m]
    overlap_breaking: RealRows = state("overlap")
    overlap_solved_up_to: RealRows = state("overlap")  # processing threshold, likewise, or AS_LINKS [m]
    # the overlaps of trees that can move, in the order of relaxation
    overlap_sorted: IntRows = state("overlap")
    count_contacts: IntRows = state("count")  # columns: THERE to RESETS_SEEN
