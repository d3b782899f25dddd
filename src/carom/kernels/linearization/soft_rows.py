"""Rows that correct an error, linearised: rigid ones, and those that yield as `dynamics.yielding` says."""

import warp as wp

from carom.kernels.dynamics.yielding import impedance_at, impedance_slope, spring_and_damper
from carom.kernels.linearization.dof_motion import add_inertia_changes
from carom.kernels.linearization.matrices import add_products, clear
from carom.kernels.structs import Model, Settings, State, StepBatch, StepSpace
from carom.kernels.types import Int32, Vector4, func, real

# The size of the errors of a constraint is the error of its only row.
ERROR_ITSELF = wp.constant(Int32(-1))


@func
def rigid_law(space: StepSpace, gain: real) -> Vector4:
    """As `yielding_law`, of rows that correct the part `gain` of their error in a unit of time [1/s]."""
    return Vector4(0.0, gain, space.regular, 0.0)


@func
def follows_own_mass(space: StepSpace, yields: bool, stated: real) -> bool:
    """Whether a row yields for its own inverse mass; `stated` is that which a file states, or 0."""
    return wp.where(yields, stated <= 0.0, space.regular > 0.0)


@func
def yielding_law(settings: Settings, reference: Vector4, impedance: Vector4, size: real) -> Vector4:
    """How a row of a compliant constraint yields whose errors have a size.

    Returns:
        Which share of the velocity before the step it keeps; the pull of its spring, a velocity per error
        [1/s]; softness per inverse mass; the derivative of the impedance by the size, relative to it.
    """
    d = impedance_at(reference, impedance, size)
    stiffness, damping = spring_and_damper(settings, reference, impedance)
    slope = impedance_slope(reference, impedance, size) / d
    h = settings.time_step
    return Vector4(1.0 - h * damping, h * stiffness * d, (1.0 - d) / d, slope)


@func
def write_mass_changes(
    model: Model,
    state: State,
    space: StepSpace,
    steps: StepBatch,
    place: Int32,
    world: Int32,
    row: Int32,
) -> real:
    """Write how the inverse mass J M⁻¹ Jᵀ of a row changes with the positions at a constant J.

    The memory of M⁻¹ Jᵀ of all rows, which is written later, gets M⁻¹ Jᵀ of this one, then its changes.

    Returns:
        The inverse mass.
    """
    n = space.dofs
    response = place * n * space.most_rows
    change = response + n
    clear(steps.response, response, 2 * n)
    add_products(
        steps.response, response, n, real(1.0), steps.jacobian, row * n, n,
        steps.inverse, place * n * n, n, 1, n, n,
    )  # fmt: skip
    inverse = real(0.0)
    last = Int32(-1)
    for dof in range(n):
        share = steps.jacobian[row * n + dof]
        if share != 0.0:
            inverse += share * steps.response[response + dof]
            tree = space.dof_tree[dof]
            # Dofs of a tree follow each other.
            if tree != last:
                add_inertia_changes(model, state, space, steps, place, world, tree, response, change)
                last = tree + 0
    return inverse


@func
def set_error(
    space: StepSpace,
    steps: StepBatch,
    place: Int32,
    row: Int32,
    law: Vector4,
    error: real,
    size: Int32,
    inverse_mass: real,
    share: real,
    of_row: bool,
):
    """Set the right side and the softness of a row that holds and corrects an error.

    `steps.side` of the row has the derivatives of the error by positions, `steps.rate` those by which its
    rate, less that of before the step which it keeps, changes as its Jacobian turns.

    Args:
        space: The tangent space.
        steps: The steps.
        place: The place.
        row: The row.
        law: How it yields.
        error: Its error.
        size: Where `steps.response` has the derivatives of the size of all errors, or `ERROR_ITSELF`.
        inverse_mass: The inverse mass for which it yields.
        share: How many times as soft it is: 4 for angles, as halves of them are errors, else 1.
        of_row: Whether that is its own, of which `write_mass_changes` has written the changes.
    """
    n = space.dofs
    count = row - place * space.most_rows
    softness = share * law[2] * inverse_mass
    softens = real(0.0)
    if law[2] > 0.0:
        # Softness has the factor (1 - d) / d.
        softens = -softness * law[3] * (1.0 + law[2]) / law[2]
    impulse = steps.row_impulse[row]
    side = row * space.columns
    change = place * n * space.most_rows + n
    for dof in range(n):
        by_position = steps.side[side + dof]
        growth = by_position + 0.0
        if size >= 0:
            growth = steps.response[size + dof]
        found = -law[1] * (by_position + error * law[3] * growth) - steps.rate[row * n + dof]
        found -= impulse * softens * growth
        if of_row:
            found -= impulse * share * law[2] * steps.response[change + dof]
        steps.side[side + dof] = found
        steps.side[side + n + dof] = law[0] * steps.jacobian[row * n + dof]
    steps.beta[row * space.most_rows + count] += softness
    if of_row:
        steps.row_yield[row] = share * law[2]


@func
def let_row_yield(
    model: Model,
    state: State,
    space: StepSpace,
    steps: StepBatch,
    place: Int32,
    world: Int32,
    row: Int32,
    impulse: real,
):
    """Let the rigid row of a dof yield by the little that rows of the converged solver do, if it holds."""
    entry = row * space.most_rows + row - place * space.most_rows
    if space.regular > 0.0 and steps.alpha[entry] != 0.0:
        n = space.dofs
        inverse_mass = write_mass_changes(model, state, space, steps, place, world, row)
        change = place * n * space.most_rows + n
        steps.beta[entry] += space.regular * inverse_mass
        steps.row_yield[row] = space.regular
        steps.row_impulse[row] = impulse
        for dof in range(n):
            softens = impulse * space.regular * steps.response[change + dof]
            steps.side[row * space.columns + dof] -= softens
