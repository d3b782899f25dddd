"""What collision detection and contact response work on: `Shapes`, `Pairs`, `Contacts`.

As in `layouts.model`, a field's axis is the first word of its name. A *manifold* is at most four contacts
of the same two shapes, one after the other; they are sorted by the lower, then by the higher row of the two.
"""

from typing import TYPE_CHECKING, Any

from carom.layouts.types import (
    ArrayType,
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
    Transforms,
    Vector3,
    Vector3Rows,
    Vector4,
    Vector4Rows,
    Vector8,
    Vector8Rows,
    Vectors3,
    Vectors4,
    real,
    struct,
)

MARGIN = 0.001
"""Collision margin of shapes made from files [m]."""

# Columns of `Pairs.count_pairs`.
PAIRS, LEAVES, BOUNDED, PLANES, READINESS, LEAF_LENGTH, START_CONTACTS = 0, 1, 2, 3, 4, 5, 6
COLUMNS = 7
# What START_CONTACTS is, the number of contacts at the start of a step, before they have been put aside.
NONE_KEPT = -1
# What READINESS says of shapes between steps: they are where the last step saw them; they have been placed
# since; and the hierarchy has been built over them.
STALE, PLACED, IN_HIERARCHY = 0, 1, 2
# Buckets of the sort along the curve.
RADIX = 256
# Column of `Contacts.count_contacts`: contacts there are.
THERE = 0
# A contact or a user constraint adds at most this many rows.
ROWS_PER_PAIR = 6
# Corners of the polytope at most; it has twice as many faces.
MOST_CORNERS = 64


@struct
class Shapes:
    """Geometry and surface of everything that touches.

    All worlds share the geometry. As in `Model`, what has a leading world axis may differ between them.
    """

    shape_link: Ints
    shape_tree: Ints
    shape_kind: Ints
    shape_size: Vectors3  # see `codes.ShapeKind`
    shape_pose: Transforms  # in the link's inertial frame
    shape_rolling: Ints  # see `codes.Rolling`
    shape_margin: Reals
    shape_breaking: Reals  # distance at which a contact is given up [m]
    shape_ccd_radius: Reals
    shape_first_vertex: Ints
    shape_vertex_count: Ints
    shape_first_face: Ints
    shape_face_count: Ints
    shape_flat_faces: Ints  # of hulls: so many of its faces, the first, are large enough to lie on
    shape_center: Vectors3  # of the bounds in the shape frame; of hulls, triangle meshes, height fields
    shape_columns: Ints  # points in one row of a height field
    shape_first_node: Ints  # of a triangle mesh's hierarchy, see `triangle_hierarchy`
    shape_leaf_count: Ints  # leaves of that hierarchy; a power of two

    # Polyhedra: vertices in the shape frame; faces with their outward planes (n, d), n x = d, and
    # their corners counter-clockwise as seen from outside. A triangle mesh's faces are its triangles.
    # The vertices of a height field are its grid points row by row, x fastest.
    vertex_position: Vectors3
    face_plane: Vectors4
    face_first_corner: Ints  # row of `corner_vertex`
    face_corner_count: Ints
    corner_vertex: Ints  # row of `vertex_position`
    node_lower: Vectors3  # bounds in the shape frame
    node_upper: Vectors3

    link_first_shape: Ints
    link_shape_count: Ints
    link_group: Ints
    link_mask: Ints
    link_self_collision: Ints  # loading flags that decide about collisions within the body
    link_lateral_friction: RealRows
    link_rolling_friction: RealRows
    link_spinning_friction: RealRows
    link_restitution: RealRows
    link_stiffness: RealRows  # negative: rigid
    link_contact_damping: RealRows
    link_friction_anchor: IntRows
    link_anisotropy: Vector3Rows  # factors on friction along the axes of the inertial frame
    link_processing_threshold: RealRows  # contacts of shapes farther apart are not solved [m]

    # Pairs of links whose collisions users switched on or off, sorted by the two link rows.
    filter_link_a: Ints
    filter_link_b: Ints
    filter_enabled: Ints


@struct
class Pairs:
    """Intermediate results of collision detection; `engine.detection_capacity` says how long they must be."""

    shape_position: Vector3Rows  # of the shape frame, in world axes
    shape_frame: Matrix3Rows  # its rotation matrix
    shape_lower: Vector3Rows  # bounds in world axes, without any threshold
    shape_upper: Vector3Rows
    shape_code: IntRows  # place along a space-filling curve
    shape_order: IntRows  # shapes sorted by it, then the planes
    shape_sorted: IntRows  # the same halfway through a sort
    shape_motion: RealRows  # how far continuous detection looks ahead for it [m]
    shape_pair_end: IntRows  # end of the pairs whose first shape it is

    # Bounds of the hierarchy over `shape_order`; node 1 is the root, nodes 2n and 2n + 1 are below n.
    node_lower: Vector3Rows
    node_upper: Vector3Rows
    bucket_end: IntRows  # of a radix sort

    pair_shapes: Index4Rows  # shape a, shape b, 0, 0; sorted
    pair_found: Index4Rows  # the same as found

    candidate_terms: Vector8Rows  # see the CANDIDATE_ columns in `codes`
    polygon_a: Vector3Rows  # corners of touching faces
    polygon_b: Vector3Rows
    polygon_clipped: Vector3Rows
    polytope_point: Vector3Rows  # difference of a point of shape a and one of shape b
    polytope_point_a: Vector3Rows
    polytope_plane: Vector4Rows  # of a face: outward normal, distance from the origin
    polytope_face: Index4Rows  # its corners, and 1 if it is in use
    polytope_edge: Index4Rows  # edges of the hole where a new corner goes

    # What the contacts of the last substep leave to their successors: in the first half those at the
    # start of the step, in the second those of later substeps.
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
    previous_taken: IntRows  # 1 once a contact has been matched with it

    # Its columns are PAIRS and so on.
    count_pairs: IntRows


@struct
class Contacts:
    """Contact points; they persist from step to step."""

    contact_shapes: Index4Rows  # shape a, shape b, link a, link b
    contact_local_a: Vector3Rows  # in the links' inertial frames
    contact_local_b: Vector3Rows
    contact_anchor_a: Vector3Rows  # where it began to stick, in the links' inertial frames
    contact_anchor_b: Vector3Rows
    contact_point_a: Vector3Rows  # in world axes
    contact_point_b: Vector3Rows
    contact_normal: Vector3Rows  # on b, towards a
    contact_direction1: Vector3Rows  # friction directions
    contact_direction2: Vector3Rows
    contact_distance: RealRows  # negative: penetration
    contact_impulse: Vector3Rows  # of the last substep: normal, along directions 1 and 2
    contact_warm_start: RealRows  # what `warm_starting.next_warm_start` said after it
    count_contacts: IntRows  # its column is THERE


@struct
class UserConstraints:
    """Constraints that users put between two links, or a link and the world."""

    user_kind: Ints  # `codes.UserConstraintKind`
    user_tree_a: Ints
    user_link_a: Ints
    user_tree_b: Ints  # -1: the world
    user_link_b: Ints
    user_pivot_a: Vectors3  # in the inertial frame of the link
    user_pivot_b: Vectors3  # likewise; in world axes where there is no body b
    user_frame_a: Quaternions
    user_frame_b: Quaternions
    user_axis: Vectors3  # in the inertial frame of link a
    user_max_impulse: Reals
    user_gear_ratio: Reals
    user_gear_auxiliary: Ints  # link row of a joint whose motion is subtracted, -1 for none
    user_relative_target: Reals
    user_erp: Reals
    user_enabled: IntRows  # 0: as if it were not there


@struct
class ManifoldBlock:
    """Up to four contacts of the same two trees, relaxed together; see `kernels.solver.rigid_manifolds`.

    Normal rows are those of the contacts; of the friction rows the contacts have two in turn. A row of a
    Delassus matrix, J M⁻¹ Jᵀ times effective masses, says by how much an impulse lowers the impulses wanted
    along the other rows.
    """

    place: Index4  # as `row_place`
    matrices: Int32  # where in `matrix_block` the matrices of articulated trees are, or -1
    members: Index4  # its contacts, -1 for none
    count: Int32
    friction: Vector4  # coefficients

    # Of rigid bodies: impulses before a sweep, and the direction in which they go on after it.
    normal_before: Vector4
    normal_search: Vector4
    friction_before: Vector8
    friction_search: Vector8
    normal_delassus: Matrix4
    normal_share: Vector4
    normal_softness: Vector4
    normal_inverse_mass: Vector4
    normal_impulse: Vector4
    # Changes of impulses if nothing bounded them. They are written down at all so that compilers
    # compute them four at a time.
    normal_wanted: Vector4

    friction_delassus: Matrix8
    friction_share: Vector8
    friction_inverse_mass: Vector8
    friction_impulse: Vector8
    friction_wanted: Vector8


@struct
class ManifoldSide:
    """One of the two rigid bodies of a manifold block, as the rows of the block see it.

    A row of a response is what an impulse does to the velocities of the dofs. Weighted Jacobians have a row
    for each dof: by how much its velocity lowers the impulses wanted.
    """

    normal_weighted: Matrix84
    normal_response: Matrix48
    friction_weighted: Matrix8
    friction_response: Matrix8


@struct
class ContactTerms:
    """A contact as its rows need it, in world axes."""

    ends: Index4  # tree and link of a, then of b
    point_a: Vector3
    point_b: Vector3
    normal: Vector3
    lateral1: Vector3  # friction directions, scaled where friction is anisotropic
    lateral2: Vector3
    rolling1: Vector3  # directions as they were found
    rolling2: Vector3
    drift: Vector3  # since it began to stick, where it has a friction anchor
    distance: real
    friction: Vector3  # coefficients: lateral, rolling, spinning
    softness: real
    erp: real
    start: Vector3  # impulses to start from
    ignored: Int32  # 1: too far apart to be solved
    from_forces: real  # velocity along the normal that forces gave it in this substep, where it can rebound
    carried: Vector3  # velocity of a's point against b's that comes from fixed bases which move
    carried_spin: Vector3  # likewise the angular velocity


if TYPE_CHECKING:
    ManifoldBlocks = Any
    ManifoldSides = Any
    TermsRows = Any
else:
    ManifoldBlocks = ArrayType(ManifoldBlock, 2)
    ManifoldSides = ArrayType(ManifoldSide, 2)
    TermsRows = ArrayType(ContactTerms, 2)


@struct
class PairRows:
    """Constraint rows over up to two trees, and the islands they join: intermediate results."""

    row_place: Index4Rows  # first block in `delta_velocity` and number of blocks, of a and of b
    row_start: IntRows  # first block of the row in `jacobian_row`: those of a, then those of b
    row_terms: Vector8Rows  # see the ROW_ columns in `codes`
    row_bound: IntRows  # row whose impulse bounds this one, -1 for none
    jacobian_row: Vector4Rows
    jacobian_response: Vector4Rows  # inverse mass matrix times the row
    entry_row: RealRows
    entry_response: RealRows

    tree_first_constraint: IntRows  # islands as linked lists that start at their root
    tree_first_contact: IntRows
    tree_contacts: IntRows  # whether it has contacts itself, and which: see `kernels.solver.warm_starting`
    tree_rest: (
        IntRows  # of the root of an island: how much at rest that is, see `kernels.solver.warm_starting`
    )
    tree_awake: IntRows  # of the root of an island: 1 if a tree of it is active, 0 if it may fall asleep
    constraint_next: IntRows
    contact_next: IntRows
    order_first: IntRows  # first contact of each manifold, in the order in which they are relaxed
    order_island: IntRows  # what they are sorted by: the last tree of its island
    contact_rows: (
        Index4Rows  # rows of a contact: normal, lateral pair, rolling pair (or -1), spinning (or -1)
    )
    unit_code: IntRows  # what an island's sweep relaxes, in order: a contact, or -1 - manifold block

    terms: TermsRows  # of the contacts of the manifold whose rows are being written
    manifold_block: ManifoldBlocks
    side: ManifoldSides  # of each manifold block its body a, then its body b
    matrix_block: Vector4Rows  # see `kernels.solver.articulated_manifolds`
    entry_matrix: RealRows

    user_first_row: IntRows
    visit_row: IntRows  # rows of motors, limits and user constraints in their order: -1 - row of the latter


# Fields that show another array's blocks entry by entry.
ROW_ENTRY_VIEWS = {
    "entry_row": "jacobian_row",
    "entry_response": "jacobian_response",
    "entry_matrix": "matrix_block",
}
