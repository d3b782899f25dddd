"""Data of collision detection, contacts and the solver: `Shapes`, `Pairs`, `Contacts`, `PairRows`.

As in `layouts.model`, a field's axis is the first word of its name. A *manifold* is at most four contacts
of the same two shapes, in contiguous rows; manifolds are sorted by the lower, then by the higher shape row.
"""

from carom.layouts.types import (
    Index2,
    Index2Rows,
    Index4,
    Index4Rows,
    Int32,
    IntRows,
    Ints,
    Matrix3Rows,
    Matrix4,
    Matrix8,
    Matrix48,
    Matrix84,
    Quaternions,
    RealRows,
    Reals,
    Rows,
    Transforms,
    Vector2,
    Vector3,
    Vector3Rows,
    Vector4,
    Vector4Rows,
    Vector6,
    Vector8,
    Vector12,
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
# Maximum number of rows of a contact or a user constraint.
ROWS_PER_PAIR = 6
# Maximum number of vertices of EPA's polytope, as in Bullet; it has up to twice as many faces.
MAX_CORNERS = 128


@struct
class Shapes:
    """Geometry and surfaces of the collision shapes, and with which links these collide.

    All worlds share the geometry. As in `Model`, fields with a leading world axis may differ between worlds.
    """

    shape_link: Ints = parameter("shape")
    shape_tree: Ints = parameter("shape")
    shape_kind: Ints = parameter("shape")
    shape_size: Vectors3 = parameter("shape")  # see `codes.ShapeKind`
    shape_pose: Transforms = parameter("shape")  # in the link's inertial frame
    shape_part: Ints = parameter("shape")  # see `codes.Part`
    shape_depth: Ints = parameter("shape")  # in so many compounds, one in the other, Bullet has it
    # where it is in the tree of its compound, see `model.placed_pieces`
    shape_path: Ints = parameter("shape")
    shape_margin: Reals = parameter("shape")
    shape_breaking: Reals = parameter("shape")  # breaking distance of contacts [m]
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
    link_center: Vectors3 = parameter("link")
    link_extents: Vectors3 = parameter("link")  # half the size
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


@struct
class UserConstraints:
    """Constraints created by users, between two links or a link and the world."""

    user_kind: Ints = parameter("user")  # `codes.UserConstraintKind`
    user_tree_a: Ints = parameter("user")
    user_link_a: Ints = parameter("user")
    user_tree_b: Ints = parameter("user")  # -1: the world
    user_link_b: Ints = parameter("user")
    user_pivot_a: Vectors3 = parameter("user")  # in the inertial frame of the link
    user_pivot_b: Vectors3 = parameter("user")  # likewise; in the world frame if there is no body b
    user_frame_a: Quaternions = parameter("user")
    user_frame_b: Quaternions = parameter("user")
    user_axis: Vectors3 = parameter("user")  # in the inertial frame of link a
    user_max_impulse: Reals = parameter("user")
    # of a weld that yields, see `kernels.solver.user_constraints.length_of_turn`
    user_gear_ratio: Reals = parameter("user")
    # link row of a joint whose motion is subtracted, -1 for none
    user_gear_auxiliary: Ints = parameter("user")
    user_relative_target: Reals = parameter("user")
    user_polynomial: Vectors4 = parameter("user")  # of a coupling, see `scene.user_constraints`
    user_erp: Reals = parameter("user")
    # of a compliant one: time constant, damping ratio, midpoint, power
    user_reference: Vectors4 = parameter("user")
    user_impedance: Vectors4 = parameter("user")  # of a compliant one, see `kernels.dynamics.yielding`
    # of a compliant one: inverse mass of rows about axes, or 0
    user_inverse_inertia: Reals = parameter("user")
    # parts of the path of a tendon, of a second one, or of the frames of a transmission
    user_first_path: Ints = parameter("user")
    user_path_count: Ints = parameter("user")
    # first part of the second path; the end of all parts if there is none
    user_second_path: Ints = parameter("user")
    user_actuator: Ints = parameter("user")  # row of the actuator of a transmission
    user_is_wrench: Ints = parameter("user")  # 1: a transmission to a site, a wrench along its axes
    # of a tendon: stiffness, damping, lengths between which it is slack; see `tendons`
    user_spring: Vectors4 = parameter("user")
    user_armature: Reals = parameter("user")  # of a tendon: inertia along it
    # of a tendon: least and greatest length, friction, margin; see `tendons`
    user_range: Vectors4 = parameter("user")
    user_enabled: IntRows = parameter("user")  # 0: no effect

    # Parts of paths.
    path_kind: Ints = parameter("path")  # `codes.PathKind`
    path_link: Ints = parameter("path")  # row of the link, -1 for the world
    path_point: Vectors3 = parameter("path")  # in the inertial frame of the link, or in the world
    # likewise, of the frame of a cylinder or of a site that is a transmission's
    path_turn: Quaternions = parameter("path")
    path_size: Reals = parameter("path")  # share of a joint, radius, or divisor of a pulley
    # 1: the path goes around on the side of a point, or within if the point is inside
    path_has_side: Ints = parameter("path")
    path_side_link: Ints = parameter("path")
    path_side_point: Vectors3 = parameter("path")


@struct
class ManifoldBlock:
    """Up to four contacts of the same two trees, relaxed together; see `kernels.solver.rigid_manifolds`.

    Each contact has a normal row and two consecutive friction rows. Row i of a Delassus matrix, J M⁻¹ Jᵀ
    times effective masses, is the decrease of the other rows' wanted impulses per unit impulse along row i.
    """

    place: Index4  # as `PairRows.row_place`
    matrices: Int32  # first block of its matrices in `matrix_block` if a tree is articulated, else -1
    members: Index4  # rows of its contacts, -1 for none
    count: Int32
    yields: Int32  # 1: its friction may have a softness
    stuck: Int32  # bit i: nothing can move along normal i; bit 4 + i: along a friction row of contact i
    friction: Vector4  # coefficients

    # For rigid bodies: impulses before a sweep, and the conjugate direction of the search after it.
    normal_before: Vector4
    normal_search: Vector4
    friction_before: Vector8
    friction_search: Vector8
    normal_delassus: Matrix4
    normal_share: Vector4
    normal_softness: Vector4
    normal_inverse_mass: Vector4
    normal_impulse: Vector4
    # Changes of impulses without bounds. They are stored only so that compilers compute four at a time.
    normal_wanted: Vector4

    friction_delassus: Matrix8
    friction_share: Vector8
    friction_softness: Vector8
    friction_inverse_mass: Vector8
    friction_impulse: Vector8
    friction_wanted: Vector8


@struct
class ManifoldSide:
    """Matrices of one of the two rigid bodies of a manifold block.

    A row of a response is the change of the dofs' velocities per unit impulse. Weighted Jacobians have a row
    for each dof: the decrease of the wanted impulses per unit of its velocity.
    """

    normal_weighted: Matrix84
    normal_response: Matrix48
    friction_weighted: Matrix8
    friction_response: Matrix8


@struct
class ContactTerms:
    """Data of a contact from which its rows are computed, in world axes."""

    ends: Index4  # tree and link of a, then of b
    shape_a: Int32
    shape_b: Int32
    point_a: Vector3
    point_b: Vector3
    normal: Vector3
    lateral1: Vector3  # friction directions, scaled if friction is anisotropic
    lateral2: Vector3
    rolling1: Vector3  # friction directions, not scaled
    rolling2: Vector3
    drift: Vector3  # from its friction anchor on b to that on a, else 0 [m]
    distance: real
    friction: Vector3  # coefficients: lateral, rolling, spinning
    softness: real
    erp: real  # of a contact that yields as MuJoCo's, the damping of lateral friction [1/s]
    start: Vector3  # initial impulses
    ignored: Int32  # 1: its distance is too large for it to be solved
    from_forces: real  # change of its normal velocity by forces in this substep, if it counts
    yields: Int32  # 1: it yields as MuJoCo's contacts do, by the next two
    damping: real  # deceleration per normal velocity [1/s]
    pull: real  # acceleration by its distance, negative out of a penetration [m/s²]
    lateral_softness: real
    lateral_from_forces: Vector2  # as `from_forces`, along both directions of friction
    carried: Vector3  # velocity of a's point relative to b's by the set velocities of fixed bases
    carried_spin: Vector3  # likewise the angular velocity


@struct
class RowTerms:
    """Data of a row over two trees."""

    share: real  # impulse that would cause the whole requested change of rate if there were no others
    effective_mass: real
    inverse_mass: real
    lower: real  # bounds of the impulse
    upper: real
    impulse: real
    softness: real  # share of the impulse by which the row yields
    friction: real  # coefficient


@struct
class NormalRow:
    """The normal row of a single contact of rigid bodies; see `kernels.solver.single_contacts`.

    Responses are the changes of the velocities of a's and b's dofs per unit impulse. For a body that cannot
    move, response and Jacobian are zero.
    """

    jacobian: Vector12  # of a and b in turn, dof by dof
    response_a: Vector6
    response_b: Vector6
    share: real  # as in `RowTerms`, like the following
    effective_mass: real
    inverse_mass: real
    kept: real  # 1 - softness
    friction: real  # coefficient, of a row of spinning friction; see `kernels.solver.single_contacts`


@struct
class LateralRows:
    """The two rows of lateral or rolling friction of a single contact of rigid bodies; as `NormalRow`."""

    jacobian_a: Vector12  # of the first and the second row in turn, dof by dof
    jacobian_b: Vector12
    response_a1: Vector6
    response_a2: Vector6
    response_b1: Vector6
    response_b2: Vector6
    share: Vector2
    effective_mass: Vector2
    inverse_mass: Vector2


@struct
class PairRows:
    """Constraint rows over up to two trees, manifold blocks, and islands: intermediate results."""

    row_place: Index4Rows  # first block in `delta_velocity` and number of blocks, of a and of b
    row_start: IntRows  # first block of the row in `jacobian_row`: blocks of a, then blocks of b
    row_terms: Rows[RowTerms]
    row_bound: IntRows  # row whose impulse bounds that of this row, -1 for none
    jacobian_row: Vector4Rows
    jacobian_response: Vector4Rows  # inverse mass matrix times the transposed row
    entry_row: RealRows
    entry_response: RealRows

    tree_first_constraint: IntRows  # islands as linked lists that start at their root
    tree_first_contact: IntRows
    tree_contacts: IntRows  # bits: which contacts it has, see `kernels.solver.warm_starting`
    tree_number: IntRows  # number of its island in Bullet, see `kernels.solver.bullet_islands`; -1 for none
    # of the first tree of a batch: its first tree that is not at rest, -1 for none
    tree_first_moving: IntRows
    tree_rest: IntRows  # of an island's root: the island's state of rest, see `kernels.solver.warm_starting`
    tree_awake: IntRows  # of an island's root: 1 if a tree of it is active, 0 if it may fall asleep
    constraint_next: IntRows
    contact_next: IntRows
    contact_solved_up_to: RealRows  # processing threshold of its manifold [m]
    order_first: IntRows  # of each overlap: its first contact, -1 for none
    order_row: IntRows  # overlaps or constraints in the order of relaxation
    order_island: IntRows  # sort key of each of these: the number of its island in Bullet
    link_root: IntRows  # Bullet's islands: another link of its island, or itself if it is the root
    number_size: IntRows  # by number of an island: manifolds and constraints in it, -1 if there is none awake
    number_batch: IntRows  # number of the batch of islands in which it is
    number_first: IntRows  # by number of a batch: its first tree, -1 for none
    # rows of a contact: normal, lateral pair, rolling pair (or -1), spinning (or -1)
    contact_rows: Index4Rows
    unit_code: IntRows  # units of an island's sweep, in order; see `kernels.solver.units`

    # Single contacts of rigid bodies; those with rolling or spinning friction have two places.
    single_contact: IntRows
    single_place: Index2Rows  # first blocks of a and b in `delta_velocity`; of the other if one cannot move
    single_impulse: Vector4Rows  # along the normal and both lateral directions; coefficient of friction
    single_softness: RealRows  # of its lateral rows, 0 unless it yields
    single_normal: Rows[NormalRow]
    single_lateral: Rows[LateralRows]

    terms: Rows[ContactTerms]  # of the contacts of the unit whose rows are being written
    manifold_block: Rows[ManifoldBlock]
    side: Rows[ManifoldSide]  # of each manifold block, body a, then body b
    matrix_block: Vector4Rows  # see `kernels.solver.articulated_manifolds`
    entry_matrix: RealRows

    user_first_row: IntRows
    visit_row: IntRows  # joint rows, -1 - row of user constraints, in order of relaxation


# Fields that are views of another array's blocks, entry by entry.
ROW_ENTRY_VIEWS = {
    "entry_row": "jacobian_row",
    "entry_response": "jacobian_response",
    "entry_matrix": "matrix_block",
}
