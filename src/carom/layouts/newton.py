"""Workspaces of the converged contact solver, `NewtonWork`, and of integrators, `StageWork`.

As in `layouts.model`, a field's axis is the first word of its name. Trees that rows act on, the *members* of
an island, have their dofs in consecutive *places* of four numbers, in the order in which rows have met them.
"""

from carom.layouts.types import Int32, IntRows, RealRows, Rows, Vector6, real, struct

# Columns of `NewtonWork.count_newton`: members, places and rows of the island that is being solved.
MEMBERS, PLACES, ROWS = 0, 1, 2
# Its normals that rebound; the next free row and block of `PairRows`; 1 if something did not fit.
REBOUNDING, PAIR_ROW, PAIR_BLOCK, SHORT = 3, 4, 5, 6
NEWTON_COLUMNS = 7
# Kinds of rows: without effect; an impulse between two bounds; the first of two rows, whose impulse together
# is bounded; another row of one of these; the first row of a contact that yields, with a friction cone or
# with the edges of a pyramid, two for each row of friction.
OFF, BOUNDED, DISC, FOLLOWING, CONE, PYRAMID = 0, 1, 2, 3, 4, 5
# What a row is of: motor, limit, friction or actuator of a joint; user constraint; normal or friction of a
# contact.
OF_JOINT, OF_USER, OF_NORMAL, OF_FRICTION = 0, 1, 2, 3
# R of rigid rows of joints and user constraints, relative to their inverse mass.
JOINT_REGULAR = 1e-5


@struct
class NewtonRow:
    """One row of an island: its Jacobian, its law, and the present values of both.

    The residual is x = J Δv − b, and the impulse −x / R within its bounds.
    """

    kind: Int32
    place_a: Int32  # place of the dofs of tree a; of a row on one dof, its entry
    blocks_a: Int32  # blocks of four entries of the Jacobian over tree a; 0 for none
    place_b: Int32
    blocks_b: Int32
    start: Int32  # first block of `PairRows.jacobian_row`; -1 if the row is on one dof
    bounded_by: Int32  # row of the normal whose impulse bounds it, -1 for none
    origin: Int32  # what it is of
    source: Int32  # its row in `Scratch.row` or `PairRows`, or its contact
    state: Int32  # 0: its impulse changes with x; 1: it is at a bound
    size: Int32  # of a contact that yields: how many rows it has, with those that follow
    friction: real  # coefficient: its bound per impulse of the normal
    inverse_mass: real  # J M⁻¹ Jᵀ [1/kg or 1/(kg m²)]
    regular: real  # R: by how much its rate gives way, per unit of impulse [1/kg or 1/(kg m²)]
    target: real  # b
    lower: real
    upper: real  # also the bound of a disc
    first: real  # impulse by which the first equations are set up
    impulse: real
    rate: real  # x
    along: real  # J p, of the direction of search
    slope: real  # derivative of −impulse by x, of a disc that slides across the direction of sliding
    direction: real  # component of the direction of sliding
    # Of contacts that yield −dλ/dx = L D Lᵀ, D in `slope`: L of this row with those after it.
    couplings: Vector6
    # Kind, R and b outside rounds of impacts.
    own_kind: Int32
    own_regular: real
    own_target: real
    # Of normals:
    restitution: real
    speed: real  # rate Jv at which its sides part, before the last equations
    from_forces: real  # part of it that the forces of this substep cause
    distance: real
    impact: real  # impulse of the rounds of impacts


@struct
class NewtonWork:
    """Matrices and vectors over the dofs of an island's members, and its rows."""

    count_newton: IntRows
    tree_place: IntRows  # of a member: its place, else -1
    tree_member: IntRows  # trees of the members
    # Trees that contacts couple with each other, as lists.
    tree_neighbour: IntRows  # first entry of a tree's list, else -1
    tree_degree: IntRows  # length of the list
    neighbour_tree: IntRows
    neighbour_next: IntRows  # the next entry, else -1
    newton_row: Rows[NewtonRow]
    # The upper triangle of matrices, in blocks of 4 x 4, by rows of blocks up to their last one that may not
    # be 0 (an *envelope*). These three are by blocks of a vector.
    vector_last: IntRows  # last block of the row
    vector_own: IntRows  # last block of the row in M
    vector_start: IntRows  # block of the matrix in column 0, if it were there
    vector_change: RealRows  # Δv
    vector_push: RealRows  # M Δv
    vector_gradient: RealRows
    vector_search: RealRows
    vector_scale: RealRows  # 1 / sqrt(M_ii)
    vector_temporary: RealRows
    vector_total: RealRows  # Δv by the rounds of impacts
    matrix_mass: RealRows
    matrix_hessian: RealRows
    sliding_row: IntRows  # discs that slide
    system_entry: RealRows  # equations of their bounds
    # Of inverse dynamics with contacts:
    dof_wanted: RealRows  # velocities after the substep
    dof_asked: RealRows  # impulses that are to be added, M Δv − Jᵀ λ
    dof_pushed: RealRows  # impulses of the rows, Jᵀ λ


# What the last kernel of a substep makes of the accelerations, see `kernels.integrators.implicit`: it counts
# damping of joints, all forces that depend on velocity, or these and what rotations do to velocities.
EXPLICIT, EULER, IMPLICIT_FAST, IMPLICIT = 0, 1, 2, 3


@struct
class StageWork:
    """What a substep of several stages keeps from one stage to the next, see `kernels.integrators`.

    Velocities are in *own axes*: the angular velocity of a base in those of its link, everything else as in
    `State.dof_velocity`.
    """

    position_first: RealRows  # coordinates at the start of the substep
    dof_first: RealRows  # velocities there
    dof_stage: RealRows  # velocities at the start of the present stage
    dof_rate: RealRows  # weighted sum of the velocities of all stages so far
    dof_change: RealRows  # the same of accelerations, times the duration of the substep
    dof_applied: RealRows  # torques of users at the start of the substep
    actuator_first: RealRows  # activations at the start of the substep
    actuator_rate: RealRows  # weighted sum of their rates
