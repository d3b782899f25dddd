"""Linearised rows of a step: adding one, its status, and derivatives of its right side by inputs."""

import warp as wp

from carom.kernels.linearization.matrices import clear
from carom.kernels.structs import Scratch, Settings, StepBatch, StepSpace
from carom.kernels.types import Int32, func, real
from carom.layouts.linearization import ROW_HOLDS, ROW_LOWER, ROW_UPPER, ROWS_OF_CONTACT

# Impulses this near to a bound, relative to it, are at it: clamping rounds.
NEAR = wp.constant(real(1.0e-9))
_INFINITE = wp.constant(real(1.0e30))


@func
def note_problem(steps: StepBatch, place: Int32, problem: Int32, number: Int32):
    """Note why a step has no answer, and of what, unless there is another reason before."""
    if steps.problem[place] == 0:
        steps.problem[place] = problem
        steps.problem_of[place] = number


@func
def status_of(impulse: real, lower: real, upper: real) -> Int32:
    """Whether a row holds, or at which bound its impulse is."""
    status = Int32(ROW_HOLDS)
    if impulse <= lower + NEAR * wp.abs(lower):
        status = Int32(ROW_LOWER)
    elif impulse >= upper - NEAR * wp.abs(upper):
        status = Int32(ROW_UPPER)
    return status


@func
def share_left(impulse: real, lower: real, upper: real) -> real:
    """Which share of its nearer bound is left for an impulse that holds."""
    left = wp.min(impulse - lower, upper - impulse)
    return wp.max(left, real(0.0)) / wp.max(wp.max(wp.abs(lower), wp.abs(upper)), real(1.0e-300))


@func
def share_of_range(value: real, lower: real, upper: real) -> real:
    """Which share of a range, of which an end may be infinite, is left between a value and the nearer end."""
    size = wp.max(wp.abs(lower), wp.abs(upper))
    if upper - lower > _INFINITE:
        size = wp.max(wp.abs(value), real(1.0))
    return wp.max(wp.min(value - lower, upper - value), real(0.0)) / wp.max(size, real(1.0e-300))


@func
def bring_switch(steps: StepBatch, row: Int32, share: real):
    """Note how far a row is from a switch, unless another one is nearer."""
    known = steps.row_switch[row]
    if known < 0.0 or share < known:
        steps.row_switch[row] = share


@func
def make_room(space: StepSpace, steps: StepBatch, place: Int32, contacts: Int32):
    """Set the rows to 0 that may be added to those which are there: those of joints and of some contacts."""
    there = steps.row_count[place]
    room = space.most_rows
    first = place * room + there
    left = wp.min(room - there, space.most_of_joints + ROWS_OF_CONTACT * contacts)
    clear(steps.jacobian, first * space.dofs, left * space.dofs)
    clear(steps.through, first * space.dofs, left * space.dofs)
    clear(steps.side, first * space.columns, left * space.columns)
    for row in range(there):
        clear(steps.alpha, (place * room + row) * room + there, left)
        clear(steps.beta, (place * room + row) * room + there, left)
    for row in range(left):
        clear(steps.alpha, (first + row) * room, there + left)
        clear(steps.beta, (first + row) * room, there + left)


@func
def add_row(
    space: StepSpace,
    steps: StepBatch,
    place: Int32,
    kind: Int32,
    status: Int32,
    number: Int32,
    alpha: real,
    beta: real,
) -> Int32:
    """Add a row without Jacobian and right side; returns its number among the rows of all worlds."""
    count = steps.row_count[place]
    row = place * space.most_rows + count
    steps.row_kind[row] = kind
    steps.row_status[row] = status
    steps.row_dof[row] = number
    steps.row_yield[row] = 0.0
    steps.row_switch[row] = -1.0
    steps.alpha[row * space.most_rows + count] = alpha
    steps.beta[row * space.most_rows + count] = beta
    steps.row_count[place] = count + 1
    return row


@func
def add_row_of_dof(
    space: StepSpace,
    steps: StepBatch,
    place: Int32,
    kind: Int32,
    status: Int32,
    dof: Int32,
    alpha: real,
    beta: real,
) -> Int32:
    """As `add_row`, for a row on one dof."""
    row = add_row(space, steps, place, kind, status, dof, alpha, beta)
    steps.jacobian[row * space.dofs + dof] = 1.0
    return row


@func
def set_input(space: StepSpace, steps: StepBatch, row: Int32, first: Int32, number: Int32, derivative: real):
    """Add to a row's derivatives by the inputs that are `number`, of the list that begins with `first`."""
    given = first + 0
    while given >= 0:
        if space.input_number[given] == number:
            steps.side[row * space.columns + space.states + given] += derivative * space.input_scale[given]
        given = space.input_next[given]


@func
def rate_of_law(settings: Settings, space: StepSpace, steps: StepBatch, place: Int32, dof: Int32) -> real:
    """The velocity of a dof that actuators act by: after free motion, or before it if forces are explicit."""
    end = wp.where(settings.explicit_forces != 0, Int32(0), Int32(1))
    return steps.velocity[(3 * place + end) * space.dofs + dof]


@func
def joint_position(scratch: Scratch, space: StepSpace, world: Int32, dof: Int32) -> real:
    """Position before the step of the joint of a dof that has one."""
    return scratch.position_start[world, space.dof_position[dof]]
