"""Actuators of joints: forces that depend on a control, and on position and velocity, within bounds.

Each is a row. The force of a servo falls with position and velocity of its joint, and both are those at the
end of the substep: it is an implicit spring and damper, a soft row as those of soft contacts, and its bounds
are those of the force. All other forces are impulses that are known, rows with equal bounds.

Activations are advanced after a substep. An actuator that acts early has a force by that which follows then.
"""

import warp as wp

from carom.kernels.dynamics.motors import unless_nan
from carom.kernels.dynamics.muscles import activation_rate, muscle_force
from carom.kernels.dynamics.rows import MIN_INVERSE_MASS, add_row, inverse_mass_entry
from carom.kernels.maths.min_max import within_bounds
from carom.kernels.structs import Model, Scratch, Settings, State
from carom.kernels.types import Int32, called_func, func, real
from carom.layouts.codes import FILTER, FILTER_EXACT, INTEGRATOR, MUSCLE, UNFILTERED

# Bounds of sums beyond these are none.
_LEAST, _GREATEST = real(-1.0e30), real(1.0e30)


@func
def bounded_control(model: Model, state: State, world: Int32, actuator: Int32) -> real:
    """The control of an actuator within its range."""
    control = state.actuator_control[world, actuator]
    lower, upper = (
        model.actuator_control_lower[world, actuator],
        model.actuator_control_upper[world, actuator],
    )
    return unless_nan(within_bounds(control, lower, upper), control)


@called_func
def next_activation(model: Model, state: State, world: Int32, actuator: Int32, h: real) -> real:
    """The activation of an actuator with dynamics after a substep of `h`."""
    dynamics = model.actuator[actuator].dynamics
    control = bounded_control(model, state, world, actuator)
    activation = state.actuator_activation[world, actuator] + 0.0
    constant = model.actuator_time_constant[world, actuator]
    if dynamics == INTEGRATOR:
        activation += h * control
    elif dynamics == FILTER:
        activation += h * (control - activation) / constant
    elif dynamics == FILTER_EXACT:
        activation += (control - activation) * (1.0 - wp.exp(-h / constant))
    elif dynamics == MUSCLE:
        times = model.actuator_muscle_time[world, actuator]
        activation += h * activation_rate(control, activation, constant, times[0], times[1])
    lower = model.actuator_activation_lower[world, actuator]
    upper = model.actuator_activation_upper[world, actuator]
    return within_bounds(activation, lower, upper)


@func
def actuator_law(
    model: Model, state: State, world: Int32, actuator: Int32, length: real, speed: real, h: real
):
    """Force of an actuator at velocity 0, and stiffness and damping by which it falls, without bounds.

    What of the force grows with velocity is that of the present velocity. `h` is the length of a substep.
    """
    drive = state.actuator_activation[world, actuator]
    if model.actuator[actuator].dynamics == UNFILTERED:
        drive = bounded_control(model, state, world, actuator)
    elif model.actuator[actuator].is_early != 0:
        drive = next_activation(model, state, world, actuator, h)
    if model.actuator[actuator].is_muscle != 0:
        pull = muscle_force(model.actuator_muscle[world, actuator], length, speed, drive)
        return pull, real(0.0), real(0.0)
    gain, bias = model.actuator_gain[world, actuator], model.actuator_bias[world, actuator]
    terms = gain * drive + bias
    # Force = terms[0] - stiffness length - damping velocity; what is negative of both is explicit.
    stiffness, damping = wp.max(-terms[1], real(0.0)), wp.max(-terms[2], real(0.0))
    force = terms[0] + terms[1] * length + (terms[2] + damping) * speed
    return force, stiffness, damping


@func
def law_of_step(
    model: Model, settings: Settings, state: State, world: Int32, actuator: Int32, length: real, speed: real
):
    """As `actuator_law`, in a substep: without stiffness and damping if all forces are explicit there."""
    force, stiffness, damping = actuator_law(model, state, world, actuator, length, speed, settings.time_step)
    if settings.explicit_forces != 0:
        force -= damping * speed
        stiffness = real(0.0)
        damping = real(0.0)
    return force, stiffness, damping


@func
def rate_of_law(settings: Settings, state: State, scratch: Scratch, world: Int32, dof: Int32) -> real:
    """The rate of a dof after free motion; before it, if forces are explicit."""
    rate = state.dof_velocity[world, dof] + 0.0
    if settings.explicit_forces != 0:
        rate -= settings.time_step * scratch.dof[world, dof].free_acceleration
    return rate


@func
def within_own_range(model: Model, world: Int32, actuator: Int32, force: real) -> real:
    """A force of an actuator within its own range."""
    lower, upper = model.actuator_force_lower[world, actuator], model.actuator_force_upper[world, actuator]
    return unless_nan(within_bounds(force, lower, upper), force)


@func
def joint_law(
    model: Model, settings: Settings, state: State, world: Int32, first: Int32, position: real, rate: real
):
    """Force of all actuators of a joint on it at velocity 0, and by how much it falls with its velocity.

    `first` is the first of them. One whose force is out of its range now has the constant force at the bound.
    """
    h = settings.time_step
    total, yielding = real(0.0), real(0.0)
    actuator = first + 0
    while actuator >= 0:
        gear = model.actuator_gear[world, actuator]
        speed = gear * rate
        force, stiffness, damping = law_of_step(
            model, settings, state, world, actuator, gear * position, speed
        )
        now = force - damping * speed
        bounded = within_own_range(model, world, actuator, now)
        if bounded == now:
            total += gear * force
            yielding += gear * gear * (damping + h * stiffness)
        else:
            total += gear * bounded
        step = model.actuator[actuator].to_next + 0
        actuator = wp.where(step > 0, actuator + step, Int32(-1))
    return total, yielding


@func
def keep_forces_of_joint(
    model: Model, settings: Settings, state: State, scratch: Scratch, world: Int32, row: Int32, first: Int32
):
    """Store the forces of all actuators of a joint that has a bound of their sum, which does not bound them.

    Those of servos are the ones at the end of the substep.
    """
    h = settings.time_step
    link = model.constraint[scratch.row[world, row].constraint].link
    dof = model.link[link].first_dof
    before = rate_of_law(settings, state, scratch, world, dof)
    after = (
        state.dof_velocity[world, dof] + scratch.entry_delta_velocity[world, scratch.row[world, row].entry]
    )
    position = state.position[world, model.link[link].first_position]
    actuator = first + 0
    while actuator >= 0:
        gear = model.actuator_gear[world, actuator]
        force, stiffness, damping = law_of_step(
            model, settings, state, world, actuator, gear * position, gear * before
        )
        force -= (damping + h * stiffness) * gear * after
        state.actuator_force[world, actuator] = within_own_range(model, world, actuator, force)
        step = model.actuator[actuator].to_next + 0
        actuator = wp.where(step > 0, actuator + step, Int32(-1))


@func
def actuator_row(
    model: Model,
    settings: Settings,
    state: State,
    scratch: Scratch,
    world: Int32,
    constraint: Int32,
    row: Int32,
) -> Int32:
    """Add the row of an actuator of a revolute or prismatic joint; returns the next free row.

    Several of one joint whose sum has bounds have one row, that of the first.
    """
    actuator = model.constraint[constraint].actuator
    if model.actuator[actuator].follows != 0:
        return row
    link = model.constraint[constraint].link
    tree = model.constraint[constraint].tree
    dof = model.link[link].first_dof
    place = dof - model.tree[tree].first_dof
    h = settings.time_step
    gear = model.actuator_gear[world, actuator]
    rate = state.dof_velocity[world, dof]
    length = gear * state.position[world, model.link[link].first_position]
    before = rate_of_law(settings, state, scratch, world, dof)
    speed = gear * before
    force, stiffness, damping = law_of_step(model, settings, state, world, actuator, length, speed)
    lower, upper = model.actuator_force_lower[world, actuator], model.actuator_force_upper[world, actuator]
    # Impulse on the joint = h gear force - yielding (rate of the joint at the end).
    yielding = h * gear * gear * (damping + h * stiffness)
    inverse_mass = inverse_mass_entry(model, scratch, world, tree, place, place)
    if inverse_mass <= MIN_INVERSE_MASS:
        state.actuator_force[world, actuator] = real(0.0)
        return row
    first, second = h * gear * lower, h * gear * upper
    if gear < 0.0:
        first, second = h * gear * upper, h * gear * lower
    impulse = h * gear * force
    least, greatest = model.actuator_joint_lower[world, actuator], model.actuator_joint_upper[world, actuator]
    if model.actuator[actuator].to_next > 0:
        whole, falling = joint_law(
            model,
            settings,
            state,
            world,
            actuator,
            state.position[world, model.link[link].first_position],
            before,
        )
        impulse = h * whole
        yielding = h * falling
        first, second = h * least, h * greatest
    else:
        # Where both bounds do not overlap, that of the joint comes last.
        first, second = (
            within_bounds(first, h * least, h * greatest),
            within_bounds(second, h * least, h * greatest),
        )
    # Rows of one dof share the response to an impulse, so all have the same effective mass.
    effective_mass = 1.0 / inverse_mass
    if yielding == 0.0:
        impulse = unless_nan(within_bounds(impulse, first, second), force)
        change = impulse * inverse_mass
        return add_row(model, scratch, world, constraint, row, dof, change, effective_mass, impulse, impulse)
    softness = 1.0 / yielding
    change = impulse * softness - rate
    share = inverse_mass / (inverse_mass + softness)
    scratch.row_share[world, row] = share
    scratch.row_softness[world, row] = share * softness
    after = add_row(model, scratch, world, constraint, row, dof, change, effective_mass, first, second)
    scratch.row[world, row].soft = 1
    return after


@func
def keep_actuator_force(
    model: Model, settings: Settings, state: State, scratch: Scratch, world: Int32, row: Int32
):
    """Store the force of the actuator of a row."""
    actuator = model.constraint[scratch.row[world, row].constraint].actuator
    if model.actuator_joint_lower[world, actuator] > _LEAST or (
        model.actuator_joint_upper[world, actuator] < _GREATEST
    ):
        keep_forces_of_joint(model, settings, state, scratch, world, row, actuator)
        return
    gear = model.actuator_gear[world, actuator]
    state.actuator_force[world, actuator] = scratch.row[world, row].impulse / (settings.time_step * gear)


@func
def advance_activations(model: Model, settings: Settings, state: State, world: Int32, tree: Int32):
    """Update the activations of the actuators of a tree, after a substep in which the present ones acted."""
    h = settings.time_step
    first = model.tree[tree].first_actuator
    for actuator in range(first, first + model.tree[tree].actuator_count):
        if model.actuator[actuator].dynamics != UNFILTERED:
            after = next_activation(model, state, world, actuator, h)
            state.actuator_activation[world, actuator] = after
