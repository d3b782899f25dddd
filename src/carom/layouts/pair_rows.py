"""Data of what the solver relaxes between two trees: `UserConstraints`, manifolds, `PairRows`.

As in `layouts.model`, a field's axis is the first word of its name.
"""

from carom.layouts.types import (
    Index2Rows,
    Index4,
    Index4Rows,
    Int32,
    IntRows,
    Ints,
    Matrix4,
    Matrix8,
    Matrix48,
    Matrix84,
    Quaternions,
    RealRows,
    Reals,
    Rows,
    Vector2,
    Vector3,
    Vector4,
    Vector4Rows,
    Vector6,
    Vector8,
    Vector12,
    Vectors3,
    Vectors4,
    parameter,
    real,
    struct,
)

# Maximum number of rows of a contact or a user constraint.
ROWS_PER_PAIR = 6


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
