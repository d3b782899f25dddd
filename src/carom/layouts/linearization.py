"""Data of the kernels that linearise a step: `StepSpace` and `StepBatch`; see docs/solver.md.

A *state* is positions, velocities and activations, a *column* a state or an input. Both count over the dofs
of the tangent space, see `linearization.tangent`.
"""

from carom.layouts.types import Int32, Ints, Reals, real, struct

# What a dof is first of, where changes of positions are no differences of numbers.
SCALAR_DOF, BASE_DOF, BALL_DOF, PLANE_DOF = 0, 1, 2, 3

# What a row is of.
MOTOR_ROW, LIMIT_ROW, FRICTION_ROW, ACTUATOR_ROW, GEAR_ROW, COUPLING_ROW = 0, 1, 2, 3, 4, 5

# Status of a row.
ROW_HOLDS, ROW_LOWER, ROW_UPPER, ROW_SATURATED = 0, 1, 2, 3

# Which number of its dof, actuator or constraint an input of rows is: columns of motors, then these.
INPUT_CONTROL, INPUT_GAIN, INPUT_BIAS, INPUT_BOUND = 8, 9, 12, 15

# Why a step has no answer yet.
FOUND, OVERFLOWED, REDUNDANT = 0, 1, 2
YIELDING_LIMIT, YIELDING_FRICTION, BALL_LIMIT, MUSCLE_ROW, YIELDING_USER, BOUNDED_SUM, BASE_SPRING = range(
    3, 10
)


@struct
class StepSpace:
    """The tangent space of a world, and where the inputs of its rows are stored."""

    dofs: Int32
    states: Int32
    columns: Int32
    most_rows: Int32
    most_of_joints: Int32  # of these, rows that the kernels add
    constraints: Int32  # joint constraints
    users: Int32  # user constraints
    smoothing: real
    dof_row: Ints  # its row among all velocities
    dof_position: Ints  # its row among all positions; -1 for dofs of joints with several, and of bases
    dof_first: Ints  # what it is the first dof of: see above
    dof_hand: Reals  # of a plane, at its first dof: sign of the turn from its first axis to the second
    dof_tree: Ints
    dof_place: Ints  # among the dofs of its tree
    row_dof: Ints  # the dof of a row of velocities, or -1
    actuator_column: Ints  # column of the activation of an actuator, or -1
    # The first input of the rows of a dof's motor, of a constraint and of an actuator, and the next one; -1
    # for none.
    dof_input: Ints
    constraint_input: Ints
    actuator_input: Ints
    input_next: Ints
    input_number: Ints  # which number it is: see above
    input_scale: Reals


@struct
class StepBatch:
    """Derivatives of the steps of many worlds: each has a place, and in each array as many entries.

    Matrices are row-major, n is the number of dofs, r that of the rows that there is room for.
    """

    world: Ints
    problem: Ints  # see above
    problem_dof: Ints
    row_count: Ints  # those of pairs before, all afterwards
    row_kind: Ints  # r
    row_status: Ints
    row_dof: Ints  # of gears and couplings the user constraint
    velocity: Reals  # three times n: before the step, after free motion, of the solver
    effective: Reals  # n x n, effective mass matrix
    inverse: Reals  # n x n, its inverse; zeros where nothing can move
    force: Reals  # twice n x columns: with the accelerations of free motion, and with those of the solver
    impulse: Reals  # n: of rows on dofs, less those that are known
    row_impulse: Reals  # r
    jacobian: Reals  # r x n
    through: Reals  # r x n, derivatives of right sides by velocities after free motion
    side: Reals  # r x columns, those by states and inputs
    alpha: Reals  # r x r
    beta: Reals
    response: Reals  # n x r
    rate: Reals  # r x n
    system: Reals  # rows x rows
    solution: Reals  # rows x rows, inverse of `system`
    wanted: Reals  # r x columns
    change: Reals  # twice n x columns: of velocities without impulses, and with all
    step: Reals  # states x columns: the derivatives of the step
