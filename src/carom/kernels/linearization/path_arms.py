"""Moment arms of a path, how they change with the positions, and how rows along it are bent by that.

The arms of one path, the changes of a length and those of the arms lie in memory that only the equations of
the rows, which follow, need: of changes of velocities, and of the step.
"""

import warp as wp

from carom.kernels.linearization.dof_motion import find_reach, point_motion
from carom.kernels.linearization.link_rows import end_change
from carom.kernels.linearization.matrices import clear
from carom.kernels.linearization.rows import joint_position
from carom.kernels.linearization.wrapped_slides import cylinder_slides, sphere_slides
from carom.kernels.structs import Model, Scratch, Settings, State, StepBatch, StepSpace, UserConstraints
from carom.kernels.tendons.paths import path_orientation, path_position, turn_of
from carom.kernels.tendons.wrapping import wrapped
from carom.kernels.types import Int32, Quaternion, Vector3, Vectors3, func, real
from carom.layouts.codes import PATH_BALL, PATH_CRANK, PATH_CYLINDER, PATH_JOINT, PATH_PULLEY, PATH_SITE
from carom.layouts.linearization import MOVES_A, MOVES_B

_TINY = real(1e-15)


@func
def arms_of(space: StepSpace, place: Int32) -> Int32:
    """Where `steps.change` has the arms of a path, (n,); the changes of a length follow, (n,)."""
    return 2 * place * space.dofs * space.columns


@func
def bends_of(space: StepSpace, place: Int32) -> Int32:
    """Where `steps.step` has the derivatives of the arms of dofs (rows) by positions (columns), (n, n)."""
    return place * space.states * space.columns


@func
def clear_arms(space: StepSpace, steps: StepBatch, place: Int32):
    """Begin a path without arms."""
    n = space.dofs
    clear(steps.change, arms_of(space, place), 2 * n)
    clear(steps.step, bends_of(space, place), n * n)


@func
def write_motion(
    model: Model,
    space: StepSpace,
    steps: StepBatch,
    place: Int32,
    link: Int32,
    point: Vector3,
    target: Vectors3,
    start: Int32,
):
    """Write how a point of a link, -1 for the world, moves with all dofs, (n,) from `start` on."""
    for dof in range(space.dofs):
        target[start + dof] = Vector3(0.0, 0.0, 0.0)
    row = Int32(-1)
    if link >= 0:
        row = model.link[link].nearest_dof + 0
    while row >= 0:
        dof = space.row_dof[row]
        target[start + dof] = point_motion(steps, place * space.dofs + dof, point)
        row = model.dof[row].parent


@func
def add_force_arms(
    space: StepSpace,
    steps: StepBatch,
    place: Int32,
    reach: Int32,
    side: Int32,
    point: Vector3,
    moved: Vectors3,
    direction: Vector3,
    slot: Int32,
    angular: Int32,
    factor: real,
):
    """Add the arms of a force at a point of one of two links, or of a torque, and their changes.

    Args:
        space: The tangent space.
        steps: The steps; `reach` and `reach_side` are those of both links.
        place: The place.
        reach: How many dofs move the links.
        side: Which of both it is.
        point: The point.
        moved: How it moves with all dofs.
        direction: The force or torque, of which this adds a multiple.
        slot: Where `steps.turned` has how that turns with all dofs.
        angular: 1 for a torque.
        factor: What both are multiplied by.
    """
    n = space.dofs
    none = Vector3(0.0, 0.0, 0.0)
    linear, about = wp.where(angular == 1, none, direction), wp.where(angular == 1, direction, none)
    moment = about + wp.cross(point, linear)
    arms, bends = arms_of(space, place), bends_of(space, place)
    for index in range(reach):
        dof = steps.reach[place * n + index]
        entry = place * n + dof
        if steps.reach_side[entry] & side != 0:
            arm = wp.dot(steps.axis_angular[entry], moment) + wp.dot(steps.axis_linear[entry], linear)
            steps.change[arms + dof] += factor * arm
            for other in range(n):
                shift, turned = moved[place * n + other], steps.turned[(3 * place + slot) * n + other]
                both = steps.reach_side[place * n + other] & side != 0
                if both or wp.dot(shift, shift) + wp.dot(turned, turned) > 0.0:
                    bent = end_change(
                        space, steps, place, dof, other, both, point, shift, direction, turned, angular
                    )
                    steps.step[bends + dof * n + other] += factor * bent


@func
def add_segment_arms(
    model: Model,
    space: StepSpace,
    steps: StepBatch,
    place: Int32,
    link_a: Int32,
    a: Vector3,
    link_b: Int32,
    b: Vector3,
    factor: real,
) -> real:
    """Add the arms of the distance of two points, whose motions are `moved_a` and `moved_b`; returns it."""
    n = space.dofs
    distance = wp.length(b - a)
    if distance > _TINY and link_a != link_b:
        reach = find_reach(model, space, steps, place, link_a, link_b)
        along = (b - a) / distance
        for dof in range(n):
            apart = steps.moved_b[place * n + dof] - steps.moved_a[place * n + dof]
            steps.turned[3 * place * n + dof] = (apart - along * wp.dot(along, apart)) / distance
        first = Int32(0)
        add_force_arms(
            space, steps, place, reach, Int32(MOVES_A), a, steps.moved_a, along, first, first, -factor
        )
        add_force_arms(
            space, steps, place, reach, Int32(MOVES_B), b, steps.moved_b, along, first, first, factor
        )
    return distance


@func
def add_ball_arms(
    model: Model,
    scratch: Scratch,
    space: StepSpace,
    steps: StepBatch,
    place: Int32,
    world: Int32,
    joint: Int32,
    factor: real,
) -> real:
    """Add the arms of the angle of a spherical joint; returns the angle."""
    n = space.dofs
    first = model.link[joint].first_position
    axis, angle = turn_of(
        Quaternion(
            scratch.position_start[world, first],
            scratch.position_start[world, first + 1],
            scratch.position_start[world, first + 2],
            scratch.position_start[world, first + 3],
        )
    )
    dof = space.row_dof[model.link[joint].first_dof]
    wide = real(0.0)
    if angle > 0.0:
        wide = 0.5 / wp.tan(0.5 * angle)
    for i in range(3):
        steps.change[arms_of(space, place) + dof + i] += factor * axis[i]
        for j in range(3):
            step = Vector3(0.0, 0.0, 0.0)
            step[j] = 1.0
            turned = (step - axis * axis[j]) * wide + 0.5 * wp.cross(axis, step)
            steps.step[bends_of(space, place) + (dof + i) * n + dof + j] += factor * turned[i]
    return angle


@func
def add_crank_arms(
    model: Model,
    state: State,
    users: UserConstraints,
    space: StepSpace,
    steps: StepBatch,
    place: Int32,
    world: Int32,
    part: Int32,
) -> real:
    """Add the arms of the position of a slider; returns that position. See `tendons.paths.add_crank`."""
    n = space.dofs
    slider, crank = users.path_link[part], users.path_link[part + 1]
    origin = path_position(state, world, slider, users.path_point[part])
    point = path_position(state, world, crank, users.path_point[part + 1])
    turn = path_orientation(state, world, slider, users.path_turn[part])
    axis = wp.quat_rotate(turn, Vector3(0.0, 0.0, 1.0))
    apart = point - origin
    along = wp.dot(apart, axis)
    rod = users.path_size[part]
    square = along * along + rod * rod - wp.dot(apart, apart)
    reaches = square > 0.0
    root = wp.sqrt(wp.where(reaches, square, real(1.0)))
    share = wp.where(reaches, 1.0 - along / root, real(1.0))
    inverse = wp.where(reaches, 1.0 / root, real(0.0))
    by_point = axis * share + apart * inverse
    torque = wp.cross(axis, apart) * share
    write_motion(model, space, steps, place, slider, origin, steps.moved_a, place * n)
    write_motion(model, space, steps, place, crank, point, steps.moved_b, place * n)
    reach = find_reach(model, space, steps, place, slider, crank)
    for dof in range(n):
        entry = place * n + dof
        tilted = Vector3(0.0, 0.0, 0.0)
        if steps.reach_side[entry] & MOVES_A != 0:
            tilted = wp.cross(steps.axis_angular[entry], axis)
        parted = steps.moved_b[entry] - steps.moved_a[entry]
        longer = wp.dot(parted, axis) + wp.dot(apart, tilted)
        root_grows = (along * longer - wp.dot(apart, parted)) * inverse
        share_grows = (along * root_grows * inverse - longer) * inverse
        turned = tilted * share + axis * share_grows + parted * inverse
        steps.turned[3 * place * n + dof] = turned - apart * (root_grows * inverse * inverse)
        twisted = (wp.cross(tilted, apart) + wp.cross(axis, parted)) * share
        steps.turned[(3 * place + 1) * n + dof] = twisted + wp.cross(axis, apart) * share_grows
    first, second, whole = Int32(0), Int32(1), real(1.0)
    a, b = Int32(MOVES_A), Int32(MOVES_B)
    add_force_arms(space, steps, place, reach, b, point, steps.moved_b, by_point, first, first, whole)
    add_force_arms(space, steps, place, reach, a, origin, steps.moved_a, by_point, first, first, -whole)
    add_force_arms(space, steps, place, reach, a, origin, steps.moved_a, torque, second, second, whole)
    return wp.where(reaches, along - root, along)


@func
def write_wrapped_motions(
    space: StepSpace,
    steps: StepBatch,
    place: Int32,
    is_cylinder: bool,
    center: Vector3,
    axis: Vector3,
    start: Vector3,
    end: Vector3,
    begin: Vector3,
    finish: Vector3,
    inside: bool,
):
    """Write how the points move where a path begins and ends to touch.

    `steps.moved_a` has how its start moves, the third of `steps.turned` how its end does, and the bits of
    `steps.reach_side` which dofs move what is wrapped. `steps.moved_b` and the second of `steps.turned` get
    the motions.
    """
    n = space.dofs
    for dof in range(n):
        entry, own = place * n + dof, 3 * place * n + dof
        change_a, change_b = steps.moved_a[entry] * real(1.0), steps.turned[own + 2 * n] * real(1.0)
        carried_first, carried_last = Vector3(0.0, 0.0, 0.0), Vector3(0.0, 0.0, 0.0)
        if steps.reach_side[entry] != 0:
            change_a -= point_motion(steps, entry, start)
            change_b -= point_motion(steps, entry, end)
            carried_first = point_motion(steps, entry, begin)
            carried_last = point_motion(steps, entry, finish)
        a, b = start - center, end - center
        if is_cylinder:
            first, last = cylinder_slides(
                axis, a, b, begin - center, finish - center, inside, change_a, change_b
            )
        else:
            first, last = sphere_slides(a, b, begin - center, finish - center, inside, change_a, change_b)
        steps.moved_b[entry] = carried_first + first
        steps.turned[own + n] = carried_last + last


@func
def add_wrapping_arms(
    model: Model,
    state: State,
    users: UserConstraints,
    space: StepSpace,
    steps: StepBatch,
    place: Int32,
    world: Int32,
    part: Int32,
    link: Int32,
    at: Vector3,
    share: real,
):
    """Add the arms of a path from a point to a sphere or cylinder that is wrapped, if it is.

    Returns:
        The length up to where it ends to touch, negative if it does not, and that place. Then
        `steps.moved_a` has how it moves.
    """
    n = space.dofs
    kind, over, to = users.path_kind[part], users.path_link[part], users.path_link[part + 1]
    radius = users.path_size[part]
    there = path_position(state, world, to, users.path_point[part + 1])
    center = path_position(state, world, over, users.path_point[part])
    turn = path_orientation(state, world, over, users.path_turn[part])
    side = path_position(state, world, users.path_side_link[part], users.path_side_point[part])
    length, begin, finish = wrapped(kind, center, turn, radius, at, there, side, users.path_has_side[part])
    if length < 0.0:
        return length, finish
    axis = wp.quat_rotate(turn, Vector3(0.0, 0.0, 1.0))
    beside = side - center
    if kind == PATH_CYLINDER:
        beside -= axis * wp.dot(axis, beside)
    inside = users.path_has_side[part] != 0 and wp.length(beside) < radius
    write_motion(model, space, steps, place, to, there, steps.turned, (3 * place + 2) * n)
    # Bits of dofs that move what is wrapped.
    find_reach(model, space, steps, place, over, Int32(-1))
    write_wrapped_motions(
        space, steps, place, kind == PATH_CYLINDER, center, axis, at, there, begin, finish, inside
    )
    total = length + add_segment_arms(model, space, steps, place, link, at, over, begin, share)
    for dof in range(n):
        steps.moved_a[place * n + dof] = steps.turned[(3 * place + 1) * n + dof]
    return total, finish


@func
def add_path_arms(
    model: Model,
    state: State,
    scratch: Scratch,
    users: UserConstraints,
    space: StepSpace,
    steps: StepBatch,
    place: Int32,
    world: Int32,
    first: Int32,
    end: Int32,
) -> real:
    """Add the moment arms of a path before the step, and their changes; returns its length.

    It is what `tendons.paths.add_path` computes.
    """
    n = space.dofs
    total, share = real(0.0), real(1.0)
    link = Int32(-1)
    at = Vector3(0.0, 0.0, 0.0)
    started = Int32(0)
    part = first + 0
    while part < end:
        kind = users.path_kind[part]
        if kind == PATH_JOINT:
            dof = space.row_dof[model.link[users.path_link[part]].first_dof]
            total += users.path_size[part] * joint_position(scratch, space, world, dof)
            steps.change[arms_of(space, place) + dof] += users.path_size[part]
        elif kind == PATH_BALL:
            factor = users.path_size[part]
            total += factor * add_ball_arms(
                model, scratch, space, steps, place, world, users.path_link[part], factor
            )
        elif kind == PATH_CRANK:
            total += add_crank_arms(model, state, users, space, steps, place, world, part)
            part += 1
        elif kind == PATH_PULLEY:
            share = 1.0 / users.path_size[part]
            started = Int32(0)
        elif kind == PATH_SITE:
            to = users.path_link[part]
            there = path_position(state, world, to, users.path_point[part])
            if started != 0:
                write_motion(model, space, steps, place, to, there, steps.moved_b, place * n)
                total += share * add_segment_arms(model, space, steps, place, link, at, to, there, share)
            write_motion(model, space, steps, place, to, there, steps.moved_a, place * n)
            link = to
            at = there
            started = Int32(1)
        else:
            length, finish = add_wrapping_arms(
                model, state, users, space, steps, place, world, part, link, at, share
            )
            if length >= 0.0:
                total += share * length
                link = users.path_link[part]
                at = finish
        part += 1
    return total


@func
def scale_arms(space: StepSpace, steps: StepBatch, place: Int32, factor: real, growth: real):
    """Multiply the arms by a factor, which grows with the length."""
    n = space.dofs
    arms, bends = arms_of(space, place), bends_of(space, place)
    for dof in range(n):
        for other in range(n):
            entry = bends + dof * n + other
            along = steps.change[arms + dof] * steps.change[arms + other]
            steps.step[entry] = factor * steps.step[entry] + growth * along
    for dof in range(n):
        steps.change[arms + dof] = factor * steps.change[arms + dof]


@func
def take_arms(settings: Settings, space: StepSpace, steps: StepBatch, place: Int32, row: Int32):
    """Give a row the arms as its Jacobian, and the forces of its impulse their changes."""
    n = space.dofs
    arms, bends = arms_of(space, place), bends_of(space, place)
    push = steps.row_impulse[row] / settings.time_step
    for dof in range(n):
        steps.jacobian[row * n + dof] = steps.change[arms + dof]
        force = ((2 * place + 1) * n + dof) * space.columns
        for other in range(n):
            steps.force[force + other] += push * steps.step[bends + dof * n + other]


@func
def bend_rate(
    space: StepSpace,
    steps: StepBatch,
    place: Int32,
    row: Int32,
    before: real,
    free: real,
    after: real,
):
    """Write how a sum of the rates of a row changes as its arms do, into `steps.rate`.

    It has given shares of that before the step, that after the free motion, and that at the end.
    """
    n = space.dofs
    bends, first = bends_of(space, place), 3 * place * n
    for other in range(n):
        total = real(0.0)
        for dof in range(n):
            rate = before * steps.velocity[first + dof] + free * steps.velocity[first + n + dof]
            rate += after * steps.velocity[first + 2 * n + dof]
            total += rate * steps.step[bends + dof * n + other]
        steps.rate[row * n + other] = total


@func
def add_bent_mass(space: StepSpace, steps: StepBatch, place: Int32):
    """Add to what `write_mass_changes` has written of a row how its arms change."""
    n = space.dofs
    response, bends = place * n * space.most_rows, bends_of(space, place)
    for dof in range(n):
        rate = 2.0 * steps.response[response + dof]
        for other in range(n):
            steps.response[response + n + other] += rate * steps.step[bends + dof * n + other]
