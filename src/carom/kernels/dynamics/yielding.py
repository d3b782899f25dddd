"""How constraints yield, and how they pull back, as those of MuJoCo do.

A constraint that yields is a spring and damper of the relative motion, whatever the masses: without other
forces its error r obeys r'' = -b r' - k d r. A force f on it moves it by the acceleration (1 - d) / d A f.
A is an inverse mass; d, the impedance, grows with the error from one bound to another.

Its parameters are two vectors. The reference has time constant and damping ratio, or minus stiffness and
minus damping, then midpoint and power of the impedance's curve; the impedance has both bounds, the error at
which it reaches the second one, and the inverse mass, 0 for that of the row. A second bound of 0 stands for
constraints that are rigid.
"""

import warp as wp

from carom.kernels.dynamics.rows import MIN_INVERSE_MASS, add_row, inverse_mass_entry
from carom.kernels.maths.min_max import maximum, within_bounds
from carom.kernels.structs import Model, Scratch, Settings, State
from carom.kernels.types import Int32, Vector4, func, real

_MIN_IMPEDANCE, _MAX_IMPEDANCE = real(0.0001), real(0.9999)
_LEAST = real(1e-15)


@func
def raised(base: real, power: real) -> real:
    """A number >= 0 to a power, most often 2, which files have unless they say otherwise."""
    if power == 2.0:
        return base * base
    return wp.pow(base, power)


@func
def impedance_at(reference: Vector4, impedance: Vector4, size: real) -> real:
    """Impedance of a constraint whose error has this size."""
    first = within_bounds(impedance[0], _MIN_IMPEDANCE, _MAX_IMPEDANCE)
    last = within_bounds(impedance[1], _MIN_IMPEDANCE, _MAX_IMPEDANCE)
    if impedance[2] <= _LEAST:
        return 0.5 * (first + last)
    x = wp.abs(size) / impedance[2]
    if x >= 1.0:
        return last
    y = x
    midpoint, power = within_bounds(reference[2], _MIN_IMPEDANCE, _MAX_IMPEDANCE), reference[3]
    if power > 1.0:
        if x <= midpoint:
            y = midpoint * raised(x / midpoint, power)
        else:
            y = 1.0 - (1.0 - midpoint) * raised((1.0 - x) / (1.0 - midpoint), power)
    return first + y * (last - first)


@func
def impedance_slope(reference: Vector4, impedance: Vector4, error: real) -> real:
    """Derivative of `impedance_at` by the error."""
    first = within_bounds(impedance[0], _MIN_IMPEDANCE, _MAX_IMPEDANCE)
    last = within_bounds(impedance[1], _MIN_IMPEDANCE, _MAX_IMPEDANCE)
    width, power = impedance[2], reference[3]
    if width <= _LEAST:
        return real(0.0)
    x = wp.abs(error) / width
    if x >= 1.0:
        return real(0.0)
    rise = real(1.0)
    if power > 1.0:
        midpoint = within_bounds(reference[2], _MIN_IMPEDANCE, _MAX_IMPEDANCE)
        part = wp.where(x <= midpoint, x / midpoint, (1.0 - x) / (1.0 - midpoint))
        rise = power * wp.pow(part, power - 1.0)
    return wp.where(error < 0.0, real(-1.0), real(1.0)) * rise * (last - first) / width


@func
def spring_and_damper(settings: Settings, reference: Vector4, impedance: Vector4):
    """Stiffness [1/s²] and damping [1/s] of the relative motion, at an impedance of 1."""
    last = within_bounds(impedance[1], _MIN_IMPEDANCE, _MAX_IMPEDANCE)
    stiffness, damping = -reference[0] / (last * last), -reference[1] / last
    if reference[0] > 0.0:
        time_constant = maximum(reference[0], 2.0 * settings.time_step)
        damping = 2.0 / (last * time_constant)
        frequency = last * time_constant * reference[1]
        stiffness = 1.0 / maximum(_LEAST, frequency * frequency)
    return stiffness, damping


@func
def yielding_row(
    model: Model,
    settings: Settings,
    state: State,
    scratch: Scratch,
    world: Int32,
    constraint: Int32,
    row: Int32,
    dof: Int32,
    error: real,
    lower: real,
    upper: real,
) -> Int32:
    """Add the row of a limit or of friction that yields, on one dof; returns the next free row.

    `error` is by how much the joint is beyond its limit, with its sign; 0 for friction.
    """
    tree = model.constraint[constraint].tree
    place = dof - model.tree[tree].first_dof
    inverse_mass = inverse_mass_entry(model, scratch, world, tree, place, place)
    if inverse_mass <= MIN_INVERSE_MASS:
        return row
    h = settings.time_step
    reference = model.constraint_reference[world, constraint]
    impedance = model.constraint_impedance[world, constraint]
    d = impedance_at(reference, impedance, error)
    stiffness, damping = spring_and_damper(settings, reference, impedance)
    velocity = state.dof_velocity[world, dof]
    before = velocity - h * scratch.dof[world, dof].force
    change = before - h * (damping * before + stiffness * d * error) - velocity
    yielding = impedance[3] + 0.0
    if yielding <= 0.0:
        yielding = inverse_mass
    softness = yielding * (1.0 - d) / d
    share = inverse_mass / (inverse_mass + softness)
    scratch.row_share[world, row] = share
    scratch.row_softness[world, row] = share * softness
    after = add_row(model, scratch, world, constraint, row, dof, change, 1.0 / inverse_mass, lower, upper)
    scratch.row[world, row].soft = 1
    return after
