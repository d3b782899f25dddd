"""Joint limits: one-sided constraint rows of joints that have reached or exceeded a limit."""

import math

import warp as wp

from carom.kernels.dynamics.motors import euler_xyz, joint_quaternion
from carom.kernels.dynamics.rows import add_row, axis_effective_masses, dof_effective_mass
from carom.kernels.dynamics.yielding import yielding_row
from carom.kernels.maths.rotation import rotation_matrix
from carom.kernels.structs import Model, Scratch, Settings, State
from carom.kernels.types import Int32, Quaternion, Vector3, func, real

_EPSILON = real(2.220446049250313e-16)
_PI = real(math.pi)
_UNBOUNDED = real(1e30)
# Factor on the error of a spherical joint, in addition to the error reduction.
SPHERICAL_GAIN = real(0.2)


@func
def limit_change(settings: Settings, violation: real) -> real:
    """Requested speed back into the range of a joint that exceeds it by `violation` >= 0."""
    if settings.split_impulse == 0 or -violation > settings.split_threshold:
        return violation * settings.joint_erp / settings.time_step
    return real(0.0)


@func
def limit_rows(
    model: Model,
    settings: Settings,
    state: State,
    scratch: Scratch,
    world: Int32,
    constraint: Int32,
    row: Int32,
) -> Int32:
    """Add the rows of the limits that a revolute or prismatic joint has reached; returns the next free row.

    A violation is reduced at the joints' error reduction rate. With split impulse, one beyond the split
    threshold only stops growing. Limits with an impedance yield instead, see `yielding`.
    """
    link = model.constraint[constraint].link
    dof = model.link[link].first_dof
    tree = model.constraint[constraint].tree
    position = state.position[world, model.link[link].first_position]
    velocity = state.dof_velocity[world, dof]
    margin = model.constraint_margin[world, constraint]
    below = model.constraint_lower[world, constraint] + margin - position
    above = position - model.constraint_upper[world, constraint] + margin
    if below < 0.0 and above < 0.0:
        return row
    if model.constraint_impedance[world, constraint][1] > 0.0:
        if below >= 0.0:
            row = yielding_row(
                model, settings, state, scratch, world, constraint, row, dof, -below, 0.0, _UNBOUNDED
            )
        if above >= 0.0:
            row = yielding_row(
                model, settings, state, scratch, world, constraint, row, dof, above, -_UNBOUNDED, 0.0
            )
        return row
    bound = model.constraint_max_impulse[world, constraint]
    effective_mass = dof_effective_mass(model, scratch, world, tree, dof)
    if below >= 0.0:
        change = limit_change(settings, below) - velocity
        row = add_row(model, scratch, world, constraint, row, dof, change, effective_mass, 0.0, bound)
    if above >= 0.0:
        change = -limit_change(settings, above) - velocity
        row = add_row(model, scratch, world, constraint, row, dof, change, effective_mass, -bound, 0.0)
    return row


@func
def swing_and_twist(current: Quaternion) -> Vector3:
    """Swing angles (x, y) of a spherical joint, and its twist angle about z (z) [rad]."""
    up = Vector3(0.0, 0.0, 1.0)
    cone = wp.normalize(wp.quat_rotate(current, up))
    across = wp.cross(up, cone)
    along = wp.dot(up, cone)
    swing = Quaternion(1.0, 0.0, 0.0, 0.0)
    if along >= -1.0 + _EPSILON:
        s = wp.sqrt((1.0 + along) * 2.0)
        swing = wp.normalize(Quaternion(across[0] / s, across[1] / s, across[2] / s, s * 0.5))
    twist = wp.normalize(wp.quat_inverse(swing) * current)
    angles = euler_xyz(rotation_matrix(wp.quat_inverse(twist) * current))

    twist_angle = 2.0 * wp.acos(wp.clamp(twist[3], -1.0, 1.0))
    axis_z = twist[2]
    if twist_angle > _PI:
        twist_angle = 2.0 * wp.acos(wp.clamp(-twist[3], -1.0, 1.0))
        axis_z = -axis_z
    if axis_z < 0.0:
        twist_angle = -twist_angle
    return Vector3(angles[0], angles[1], twist_angle)


@func
def spherical_limit_rows(
    model: Model,
    settings: Settings,
    state: State,
    scratch: Scratch,
    world: Int32,
    constraint: Int32,
    row: Int32,
) -> Int32:
    """Add the rows of a spherical joint's exceeded swing and twist limits; returns the next free row."""
    link = model.constraint[constraint].link
    first = model.link[link].first_dof
    angles = swing_and_twist(joint_quaternion(model, state, world, link))
    ranges = Vector3(
        model.constraint_lower[world, constraint],
        model.constraint_upper[world, constraint],
        model.constraint_twist[world, constraint],
    )
    bound = model.constraint_max_impulse[world, constraint]
    effective_mass = axis_effective_masses(model, scratch, world, model.constraint[constraint].tree, link)
    for axis in range(3):
        excess = real(0.0)
        if angles[axis] >= ranges[axis]:
            excess = angles[axis] - ranges[axis]
        elif angles[axis] <= -ranges[axis]:
            excess = angles[axis] + ranges[axis]
        error = SPHERICAL_GAIN * excess
        if wp.abs(error) > _EPSILON:
            change = -state.dof_velocity[world, first + axis]
            change -= error * settings.joint_erp / settings.time_step
            lower = -bound if error > 0.0 else 0.0
            upper = 0.0 if error > 0.0 else bound
            row = add_row(
                model, scratch, world, constraint, row, first + axis, change, effective_mass[axis], lower,
                upper,
            )  # fmt: skip
    return row
