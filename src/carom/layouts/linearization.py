"""Data of the kernels that linearise a step: `StepSpace` and `StepBatch`; see docs/solver.md.

A *state* is positions, velocities and activations, a *column* a state or an input. Both count over the dofs
of the tangent space, see `linearization.tangent`.
"""

from carom.layouts.types import Int32, Ints, Reals, Vector3, Vector4, Vectors3, real, struct

# What a dof is first of, where changes of positions are no differences of numbers.
SCALAR_DOF, BASE_DOF, BALL_DOF, PLANE_DOF = 0, 1, 2, 3

# What a row is of.
MOTOR_ROW, LIMIT_ROW, FRICTION_ROW, ACTUATOR_ROW, GEAR_ROW, COUPLING_ROW = 0, 1, 2, 3, 4, 5
CONTACT_ROW, CONTACT_FRICTION, ROLLING_FRICTION, SPINNING_FRICTION = 6, 7, 8, 9
PRISMATIC_ROW, FIXED_ROW, POINT_TO_POINT_ROW, BASE_FRICTION_ROW = 10, 11, 12, 13
TENDON_SPRING, TENDON_FRICTION, TENDON_LIMIT, TRANSMISSION_ROW, TENDON_COUPLING_ROW = 14, 15, 16, 17, 18

# Status of a row.
ROW_HOLDS, ROW_LOWER, ROW_UPPER, ROW_SATURATED, ROW_SLIDES = 0, 1, 2, 3, 4

# Which number of its dof, actuator, constraint or link an input of rows is: columns of motors, then these.
INPUT_CONTROL, INPUT_GAIN, INPUT_BIAS, INPUT_BOUND, INPUT_FRICTION = 8, 9, 12, 15, 16

# Why a step has no answer yet.
FOUND, OVERFLOWED, REDUNDANT = 0, 1, 2
QUARTER_TURN, BALL_QUARTER_TURN, OTHER_USER, BASE_SPRING = range(3, 7)
FEATURES, MOVING_BASE, ANISOTROPY, ANCHOR, BOUNCE, TORSION, BOTH_LIMITS, CONE_SURFACE = range(7, 15)
CARRIED, PULLED = range(15, 17)
# A contact that is nearer than this to where it begins is at a switch [m].
NEAR_MARGIN = 1e-6

# Laws of contacts, see docs/contact.md.
SWEPT_LAW, RIGID_LAW, COMPLIANT_LAW = 0, 1, 2

# What `solution_of_step_kernel` does: all; rows only; what follows from them, also where the host has solved
# their equations.
ALL_STAGES, ROWS_STAGE, EQUATIONS_STAGE, RESUMED = 0, 1, 2, 3

# Which links a dof moves, bit by bit.
MOVES_A, MOVES_B = 1, 2
# A contact is known by its number and the kinds of its shapes: ((number * this) + kind of a) * this + of b.
SHAPE_KINDS = 8
# Values of `StepBatch.measured` that are no number of a motion.
UNMEASURED, WANTED = -1, -2
# At most so many rows has a contact.
ROWS_OF_CONTACT = 6
# At least so many rows there is room for: of one, its response, changes of it, and of errors are noted.
MIN_ROWS = 3


@struct
class StepSpace:
    """The tangent space of a world, and where the inputs of its rows are stored."""

    dofs: Int32
    states: Int32
    columns: Int32
    most_rows: Int32
    most_of_joints: Int32  # of these, rows of joints and of user constraints
    most_contacts: Int32  # contacts that there is room for
    constraints: Int32  # joint constraints
    users: Int32  # user constraints
    actuators: Int32
    smoothing: real
    law: Int32  # of contacts: see above
    is_given: Int32  # 1 where `StepBatch.row_asked` has impulses of contacts, see `newton.linear_noslip`
    regular: real  # softness of rigid rows of joints and user constraints, relative to their inverse mass
    dof_row: Ints  # its row among all velocities
    dof_position: Ints  # its row among all positions; -1 for dofs of joints with several, and of bases
    dof_first: Ints  # what it is the first dof of: see above
    dof_group: Ints  # the first dof of its joint or base
    dof_hand: Reals  # of a plane, at its first dof: sign of the turn from its first axis to the second
    dof_tree: Ints
    dof_place: Ints  # among the dofs of its tree
    row_dof: Ints  # the dof of a row of velocities, or -1
    actuator_column: Ints  # column of the activation of an actuator, or -1
    # The first input of the rows of a dof's motor, of a constraint, of an actuator and of the contacts of a
    # link, and the next one; -1 for none.
    dof_input: Ints
    constraint_input: Ints
    actuator_input: Ints
    link_input: Ints
    input_next: Ints
    input_number: Ints  # which number it is: see above
    input_scale: Reals


@struct
class TouchingLinks:
    """A contact that is linearised."""

    contact: Int32
    known_as: Int32  # see SHAPE_KINDS
    link_a: Int32
    link_b: Int32
    shape_a: Int32
    shape_b: Int32
    point_a: Vector3
    point_b: Vector3
    normal: Vector3  # on b, towards a
    direction1: Vector3  # of friction
    direction2: Vector3
    surface_moves: Int32  # 1: a surface of the shapes moves in its shape
    reach: Int32  # number of dofs that move a link of both: see `StepBatch.reach`
    friction: Vector3  # coefficients: lateral, rolling, spinning
    stated: Int32  # 1: a pair of the file states them, so that they do not follow those of the links
    gain: real  # by how much the requested normal velocity falls with the distance [1/s]
    # How the normal row yields, and those of lateral friction: which share of the velocity before the step is
    # kept; softness, velocity per impulse [1/kg]; its derivatives by the distance [1/(kg m)] and by the
    # coefficient of lateral friction [1/kg].
    normal_law: Vector4
    lateral_law: Vector4


@struct
class StepBatch:
    """Derivatives of the steps of many worlds: each has a place, and in each array as many entries.

    Matrices are row-major, n is the number of dofs, r that of the rows that there is room for.
    """

    world: Ints
    problem: Ints  # see above
    problem_of: Ints  # its dof, its user constraint or the kind of that, or its contact, see SHAPE_KINDS
    row_count: Ints
    row_kind: Ints  # r
    row_status: Ints
    row_dof: Ints  # of user constraints their number, of contacts see SHAPE_KINDS
    velocity: Reals  # three times n: before the step, after free motion, of the solver
    effective: Reals  # n x n, effective mass matrix
    inverse: Reals  # n x n, its inverse; zeros where nothing can move
    force: Reals  # twice n x columns: with the accelerations of free motion, and with those of the solver
    impulse: Reals  # n: of rows on dofs, less those that are known
    row_impulse: Reals  # r
    # Of rows that slide: the velocity that they still ask for, with its sign turned, and the effective mass.
    row_asked: Reals  # r
    row_mass: Reals
    # How far a row is from where it would change its status: of an impulse that has a bound, which share of
    # that is left; of a rigid contact, its distance [m]; -1 where it is not known.
    row_switch: Reals  # r
    row_yield: Reals  # r, softness per inverse mass of the row itself; 0 if it does not yield, or for another
    jacobian: Reals  # r x n
    through: Reals  # r x n, derivatives of right sides by velocities after free motion
    side: Reals  # r x columns, those by states and inputs
    alpha: Reals  # r x r
    beta: Reals
    # Of the dofs, motions per unit of their rates in world axes, the linear ones at the origin.
    axis_angular: Vectors3  # n
    axis_linear: Vectors3
    # Of a contact: the dofs that move its links, which of both they move, and by a change of each dof how the
    # points of contact move, and how the normal and both friction directions turn.
    reach: Ints  # n
    reach_side: Ints
    moved_a: Vectors3
    moved_b: Vectors3
    turned: Vectors3  # three times n
    # Of two links that are held: how their J̇ v changes with the position of each dof, linear and angular,
    # and with its velocity; see `kernels.linearization.bent_rows`.
    bent: Vectors3  # six times n
    # Of each contact, as many as there is room for, which of the motions below it has: UNMEASURED at first,
    # WANTED where a kernel has found that it needs one.
    measured: Ints
    # Of each contact that pushes nothing but is at a switch its name, see SHAPE_KINDS; -1 for others.
    near: Ints
    # Motions of contacts that the host has measured, each three times n: how `moved_a`, `moved_b` and the
    # normal change with each dof.
    measured_motion: Vectors3
    response: Reals  # n x r
    rate: Reals  # r x n
    system: Reals  # rows x rows
    solution: Reals  # rows x rows, inverse of `system`
    wanted: Reals  # r x columns
    change: Reals  # twice n x columns: of velocities without impulses, and with all
    step: Reals  # states x columns: the derivatives of the step
