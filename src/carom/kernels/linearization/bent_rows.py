"""How the accelerations J̇ v that rows of constraints ask for change, see `solver.bending`.

Motions of links are pairs, angular and linear at the origin of the world. From its leaf to its root a chain
has groups of dofs: joints, and at last the base. Seen from what precedes a group, the motion of what follows
turns with each of its dofs s as a whole: by s x V, and its acceleration by s x A.
"""

import warp as wp

from carom.kernels.integrators.frames import carried_by_turning, is_off_frame
from carom.kernels.linearization.dof_motion import is_base, point_motion
from carom.kernels.structs import Model, Settings, State, StepBatch, StepSpace
from carom.kernels.types import Int32, Vector3, func, real
from carom.layouts.linearization import MOVES_A, MOVES_B

_TURNS = wp.constant(3)  # dofs of a base before those that shift it
# Vectors of each dof in `StepBatch.bent`: J̇ v by its position, by its velocity; linear, then angular. Then
# the relative angular velocity by the same.
BY_POSITION, BY_VELOCITY = wp.constant(Int32(0)), wp.constant(Int32(2))
SPIN_BY_POSITION, SPIN_BY_VELOCITY = wp.constant(Int32(4)), wp.constant(Int32(5))
OF_BENDING = wp.constant(Int32(6))


@func
def crossed(angular: Vector3, linear: Vector3, angular_of_other: Vector3, linear_of_other: Vector3):
    """The rate at which a motion, the second one, changes that turns with the first one."""
    return wp.cross(angular, angular_of_other), (
        wp.cross(angular, linear_of_other) + wp.cross(linear, angular_of_other)
    )


@func
def motion_of_group(space: StepSpace, steps: StepBatch, place: Int32, last: Int32):
    """The motion by a group of dofs of which the last one is given, and, of a base, its shift alone."""
    angular, linear, shift = Vector3(0.0, 0.0, 0.0), Vector3(0.0, 0.0, 0.0), Vector3(0.0, 0.0, 0.0)
    group = space.dof_group[last]
    for dof in range(group, last + 1):
        rate = steps.velocity[3 * place * space.dofs + dof]
        angular += rate * steps.axis_angular[place * space.dofs + dof]
        linear += rate * steps.axis_linear[place * space.dofs + dof]
        if dof - group >= _TURNS:
            shift += rate * steps.axis_linear[place * space.dofs + dof]
    return angular, linear, shift


@func
def motion_of_chain(model: Model, space: StepSpace, steps: StepBatch, place: Int32, link: Int32):
    """Motion of a link, and its acceleration without any of dofs; 0 for the world, -1."""
    omega, moving = Vector3(0.0, 0.0, 0.0), Vector3(0.0, 0.0, 0.0)
    alpha, bent = Vector3(0.0, 0.0, 0.0), Vector3(0.0, 0.0, 0.0)
    row = Int32(-1)
    if link >= 0:
        row = model.link[link].nearest_dof + 0
    while row >= 0:
        last = space.row_dof[row]
        angular, linear, shift = motion_of_group(space, steps, place, last)
        turning, turned = crossed(angular, linear, omega, moving)
        alpha += turning
        bent += turned
        if is_base(space, last):
            bent += wp.cross(shift, angular)
        omega += angular
        moving += linear
        row = model.dof[space.dof_row[space.dof_group[last]]].parent
    return omega, moving, alpha, bent


@func
def add_bending_of_link(
    model: Model,
    space: StepSpace,
    steps: StepBatch,
    place: Int32,
    link: Int32,
    side: Int32,
    point: Vector3,
    omega_of_other: Vector3,
):
    """Add to `steps.bent` what follows from one of two links, -1 for the world."""
    n = space.dofs
    sign = wp.where(side == MOVES_A, real(1.0), real(-1.0))
    omega, moving, alpha, bent = motion_of_chain(model, space, steps, place, link)
    speed = moving + wp.cross(omega, point)
    # Of what follows the present group, seen from it.
    after, moving_after = Vector3(0.0, 0.0, 0.0), Vector3(0.0, 0.0, 0.0)
    alpha_after, bent_after = Vector3(0.0, 0.0, 0.0), Vector3(0.0, 0.0, 0.0)
    row = Int32(-1)
    if link >= 0:
        row = model.link[link].nearest_dof + 0
    while row >= 0:
        last = space.row_dof[row]
        group = space.dof_group[last]
        angular, linear, shift = motion_of_group(space, steps, place, last)
        turning, turned = crossed(angular, linear, after, moving_after)
        of_base = is_base(space, last)
        # What precedes the group, and what turns with it.
        before, moving_before = omega - angular - after, moving - linear - moving_after
        rest, moving_rest = angular + after, linear + moving_after
        alpha_rest, bent_rest = alpha_after + turning, bent_after + turned
        for dof in range(group, last + 1):
            entry = place * n + dof
            axis, lift = steps.axis_angular[entry], steps.axis_linear[entry]
            pushed, swung = crossed(axis, lift, after, moving_after)
            if of_base:
                # It turns about its centre, along axes of the world.
                swung += wp.where(dof - group < _TURNS, wp.cross(shift, axis), wp.cross(lift, angular))
                if dof - group < _TURNS:
                    before, moving_before = angular + Vector3(0.0, 0.0, 0.0), linear + Vector3(0.0, 0.0, 0.0)
                    rest, moving_rest = after + Vector3(0.0, 0.0, 0.0), moving_after + Vector3(0.0, 0.0, 0.0)
                    alpha_rest = alpha_after + Vector3(0.0, 0.0, 0.0)
                    bent_rest = bent_after + Vector3(0.0, 0.0, 0.0)
                else:
                    before, moving_before = Vector3(0.0, 0.0, 0.0), Vector3(0.0, 0.0, 0.0)
                    rest, moving_rest = omega + Vector3(0.0, 0.0, 0.0), moving + Vector3(0.0, 0.0, 0.0)
                    alpha_rest, bent_rest = alpha + Vector3(0.0, 0.0, 0.0), bent + Vector3(0.0, 0.0, 0.0)
            else:
                by_turn, by_lift = crossed(before, moving_before, axis, lift)
                pushed += by_turn
                swung += by_lift
            # By the velocity of the dof.
            target = OF_BENDING * entry + BY_VELOCITY
            spot = lift + wp.cross(axis, point)
            grown = swung + wp.cross(pushed, point) + wp.cross(axis, speed) + wp.cross(omega, spot)
            steps.bent[target] = steps.bent[target] + sign * grown
            steps.bent[target + 1] = steps.bent[target + 1] + sign * (pushed - wp.cross(omega_of_other, axis))
            target = OF_BENDING * entry + SPIN_BY_VELOCITY
            steps.bent[target] = steps.bent[target] + sign * axis
            # By its position, which moves the point, too.
            spun, slid = crossed(axis, lift, rest, moving_rest)
            kept, kept_lift = crossed(before, moving_before, spun, slid)
            carried, carried_lift = crossed(axis, lift, alpha_rest, bent_rest)
            pushed = kept + carried
            moved = point_motion(steps, entry, point)
            grown = kept_lift + carried_lift + wp.cross(pushed, point) + wp.cross(alpha, moved)
            grown += wp.cross(spun, speed)
            grown += wp.cross(omega, slid + wp.cross(spun, point) + wp.cross(omega, moved))
            target = OF_BENDING * entry + BY_POSITION
            steps.bent[target] = steps.bent[target] + sign * grown
            steps.bent[target + 1] = steps.bent[target + 1] + sign * (pushed - wp.cross(omega_of_other, spun))
            target = OF_BENDING * entry + SPIN_BY_POSITION
            steps.bent[target] = steps.bent[target] + sign * spun
        alpha_after += turning
        bent_after += turned
        after += angular
        moving_after += linear
        row = model.dof[space.dof_row[group]].parent


@func
def carry_with_base(
    model: Model,
    state: State,
    space: StepSpace,
    steps: StepBatch,
    place: Int32,
    world: Int32,
    link: Int32,
    sign: real,
) -> Vector3:
    """Times a sign what `bending.carried_with_base` is of the tree of a link; `steps.bent` gets its share."""
    carried = Vector3(0.0, 0.0, 0.0)
    row = Int32(-1)
    if link >= 0:
        row = model.link[link].nearest_dof + 0
    while row >= 0:
        group = space.dof_group[space.row_dof[row]]
        tree = space.dof_tree[group]
        if is_base(space, group) and is_off_frame(model, tree):
            pose = state.link_pose[world, model.tree[tree].first_link]
            turn = wp.transform_get_rotation(pose)
            arm = wp.quat_rotate(turn, model.link[model.tree[tree].first_link].com_from_pivot)
            entry = place * space.dofs + group
            rates = 3 * place * space.dofs + group
            omega = Vector3(steps.velocity[rates], steps.velocity[rates + 1], steps.velocity[rates + 2])
            carried = sign * carried_by_turning(omega, arm)
            for axis in range(_TURNS):
                unit = steps.axis_angular[entry + axis]
                swung = wp.cross(unit, arm)
                target = OF_BENDING * (entry + axis)
                by_position = carried_by_turning(omega, swung)
                by_velocity = wp.cross(unit, wp.cross(omega, arm)) + wp.cross(omega, swung)
                steps.bent[target + BY_POSITION] = steps.bent[target + BY_POSITION] + sign * by_position
                steps.bent[target + BY_VELOCITY] = steps.bent[target + BY_VELOCITY] + sign * by_velocity
        row = model.dof[space.dof_row[group]].parent
    return carried


@func
def find_bending(
    model: Model,
    settings: Settings,
    state: State,
    space: StepSpace,
    steps: StepBatch,
    place: Int32,
    world: Int32,
    reach: Int32,
    link_a: Int32,
    link_b: Int32,
    point_a: Vector3,
    point_b: Vector3,
):
    """What `bending_between` is of two links, -1 for the world; `steps.bent` gets its derivatives.

    Its third result is the relative angular velocity.
    """
    for index in range(reach):
        entry = OF_BENDING * (place * space.dofs + steps.reach[place * space.dofs + index])
        for vector in range(OF_BENDING):
            steps.bent[entry + vector] = Vector3(0.0, 0.0, 0.0)
    omega_a, moving_a, alpha_a, bent_a = motion_of_chain(model, space, steps, place, link_a)
    omega_b, moving_b, alpha_b, bent_b = motion_of_chain(model, space, steps, place, link_b)
    add_bending_of_link(model, space, steps, place, link_a, Int32(MOVES_A), point_a, omega_b)
    add_bending_of_link(model, space, steps, place, link_b, Int32(MOVES_B), point_b, omega_a)
    apart = bent_a + wp.cross(alpha_a, point_a) + wp.cross(omega_a, moving_a + wp.cross(omega_a, point_a))
    apart -= bent_b + wp.cross(alpha_b, point_b) + wp.cross(omega_b, moving_b + wp.cross(omega_b, point_b))
    if settings.explicit_forces != 0:
        apart += carry_with_base(model, state, space, steps, place, world, link_a, real(1.0))
        apart += carry_with_base(model, state, space, steps, place, world, link_b, real(-1.0))
    return apart, alpha_a - alpha_b - wp.cross(omega_b, omega_a), omega_a - omega_b


@func
def bend_row(
    space: StepSpace,
    steps: StepBatch,
    place: Int32,
    reach: Int32,
    row: Int32,
    time_step: real,
    direction: Vector3,
    bent: Vector3,
    is_turn: Int32,
):
    """Let a row along, or about, a direction ask for h J̇ v less; `bent` is J̇ v of all directions."""
    n = space.dofs
    side = row * space.columns
    for index in range(reach):
        dof = steps.reach[place * n + index]
        entry = OF_BENDING * (place * n + dof) + is_turn
        by_position = wp.dot(direction, steps.bent[entry + BY_POSITION])
        by_position += wp.dot(steps.turned[3 * place * n + dof], bent)
        by_velocity = wp.dot(direction, steps.bent[entry + BY_VELOCITY])
        steps.side[side + dof] -= time_step * by_position
        steps.side[side + n + dof] -= time_step * by_velocity


@func
def bend_axis(
    space: StepSpace,
    steps: StepBatch,
    place: Int32,
    reach: Int32,
    row: Int32,
    time_step: real,
    axis: Vector3,
    spin: Vector3,
    error: real,
):
    """As `bend_row`, for how axes of `held_turn` turn: J̇ v is less by |spin|² / 4 times their errors."""
    n = space.dofs
    side = row * space.columns
    square = wp.dot(spin, spin)
    for index in range(reach):
        dof = steps.reach[place * n + index]
        entry = OF_BENDING * (place * n + dof)
        by_velocity = steps.bent[entry + SPIN_BY_VELOCITY]
        by_position = 2.0 * error * wp.dot(spin, steps.bent[entry + SPIN_BY_POSITION])
        by_position += square * wp.dot(axis, by_velocity)
        steps.side[side + dof] += 0.25 * time_step * by_position
        steps.side[side + n + dof] += 0.5 * time_step * error * wp.dot(spin, by_velocity)
