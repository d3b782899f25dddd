"""Forces of the fluid around the links, linearised; see `dynamics.fluid`."""

import math

import warp as wp

from carom.kernels.dynamics.fluid import box_sizes, fluid_wrench, fourth_power, magnitudes, times
from carom.kernels.linearization.dof_motion import find_reach, follows, point_motion
from carom.kernels.linearization.link_rows import end_change
from carom.kernels.maths.min_max import greatest_entry, least_entry
from carom.kernels.maths.rotation import rotation_matrix
from carom.kernels.structs import Model, State, StepBatch, StepSpace
from carom.kernels.types import Int32, Vector3, Vector6, Vector8, func, real
from carom.layouts.codes import IN_FLUID_AS_BOX, IN_FLUID_AS_ELLIPSOID

_PI = real(math.pi)
_LEAST = real(1e-15)
_FACE, _MOMENT = real(1.0 / 64.0), real(8.0 * math.pi / 15.0)


@func
def joined(force: Vector3, torque: Vector3) -> Vector6:
    """A force and a torque as one vector."""
    return Vector6(force[0], force[1], force[2], torque[0], torque[1], torque[2])


@func
def box_change(
    size: Vector3,
    density: real,
    viscosity: real,
    spin: Vector3,
    flow: Vector3,
    more_spin: Vector3,
    more_flow: Vector3,
) -> Vector6:
    """Change of `fluid.force_on_box` by changes of both velocities."""
    mean = (size[0] + size[1] + size[2]) / 3.0
    areas = Vector3(size[1] * size[2], size[2] * size[0], size[0] * size[1])
    x, y, z = fourth_power(size[0]), fourth_power(size[1]), fourth_power(size[2])
    swept = Vector3(size[0] * (y + z), size[1] * (z + x), size[2] * (x + y))
    force = -3.0 * _PI * mean * viscosity * more_flow
    force -= density * times(areas, times(magnitudes(flow), more_flow))
    torque = -_PI * mean * mean * mean * viscosity * more_spin
    torque -= 2.0 * _FACE * density * times(swept, times(magnitudes(spin), more_spin))
    return joined(force, torque)


@func
def ellipsoid_change(
    shape: Vector8,
    added: Vector6,
    density: real,
    viscosity: real,
    spin: Vector3,
    flow: Vector3,
    more_spin: Vector3,
    more_flow: Vector3,
) -> Vector6:
    """Change of `fluid.force_on_ellipsoid` by changes of both velocities."""
    axes = Vector3(shape[0], shape[1], shape[2])
    blunt, slender, angular, kutta, magnus = shape[3], shape[4], shape[5], shape[6], shape[7]
    greatest, least = greatest_entry(axes), least_entry(axes)
    middle = axes[0] + axes[1] + axes[2] - greatest - least
    mean = 2.0 / 3.0 * (axes[0] + axes[1] + axes[2])
    volume = 4.0 / 3.0 * _PI * axes[0] * axes[1] * axes[2]

    of_flow, of_spin = Vector3(added[0], added[1], added[2]), Vector3(added[3], added[4], added[5])
    momentum, more_momentum = density * times(of_flow, flow), density * times(of_flow, more_flow)
    turning, more_turning = density * times(of_spin, spin), density * times(of_spin, more_spin)
    force = wp.cross(more_momentum, spin) + wp.cross(momentum, more_spin)
    torque = wp.cross(more_momentum, flow) + wp.cross(momentum, more_flow)
    torque += wp.cross(more_turning, spin) + wp.cross(turning, more_spin)

    # Relative growth of the speed, and of what makes up the area that the flow sees.
    areas = Vector3(axes[1] * axes[2], axes[2] * axes[0], axes[0] * axes[1])
    squares = times(areas, areas)
    normal, more_normal = times(squares, flow), times(squares, more_flow)
    projected, square, speed = wp.dot(normal, flow), wp.dot(normal, normal), wp.length(flow)
    area, share = real(0.0), real(0.0)
    area_growth, share_growth, faster = real(0.0), real(0.0), real(0.0)
    if speed > _LEAST:
        faster = wp.dot(flow, more_flow) / speed
        by_square = 2.0 * wp.dot(normal, more_normal) / square
        by_projected = 2.0 * wp.dot(normal, more_flow) / projected
        area = _PI * wp.sqrt(square / projected)
        share = projected / (speed * square)
        area_growth = 0.5 * area * (by_square - by_projected)
        share_growth = share * (by_projected - faster / speed - by_square)
    force += magnus * density * volume * (wp.cross(more_spin, flow) + wp.cross(spin, more_flow))
    lift = wp.cross(normal, flow)
    more_lift = wp.cross(more_normal, flow) + wp.cross(normal, more_flow)
    lifted = (share_growth * area + share * area_growth) * wp.cross(lift, flow)
    lifted += share * area * (wp.cross(more_lift, flow) + wp.cross(lift, more_flow))
    force += kutta * density * lifted

    whole = _PI * greatest * middle
    seen = blunt * area + slender * (whole - area)
    drag = 3.0 * _PI * mean * viscosity + density * speed * seen
    more_drag = density * (faster * seen + speed * (blunt - slender) * area_growth)
    force -= drag * more_flow + more_drag * flow
    most = _MOMENT * middle * fourth_power(greatest)
    moments = _MOMENT * Vector3(
        axes[0] * fourth_power(wp.max(axes[1], axes[2])),
        axes[1] * fourth_power(wp.max(axes[2], axes[0])),
        axes[2] * fourth_power(wp.max(axes[0], axes[1])),
    )
    shares = angular * moments + slender * (Vector3(most, most, most) - moments)
    resisted = times(spin, shares)
    size = wp.length(resisted)
    grows = wp.dot(resisted, times(more_spin, shares)) / wp.max(size, _LEAST)
    torque -= (_PI * mean * mean * mean * viscosity + density * size) * more_spin + density * grows * spin
    return joined(force, torque)


@func
def wrench_change(
    model: Model,
    world: Int32,
    link: Int32,
    spin: Vector3,
    flow: Vector3,
    more_spin: Vector3,
    more_flow: Vector3,
) -> Vector6:
    """Change of force and torque of the fluid on a link by changes of both velocities, all in its axes."""
    density, viscosity = model.fluid_density[world, 0] + 0.0, model.fluid_viscosity[world, 0] + 0.0
    found = Vector6()
    if model.link[link].fluid == IN_FLUID_AS_BOX:
        mass = model.link_mass[world, link]
        if mass >= _LEAST:
            size = box_sizes(mass, model.link_inertia[world, link])
            found = box_change(size, density, viscosity, spin, flow, more_spin, more_flow)
    if model.link[link].fluid == IN_FLUID_AS_ELLIPSOID:
        found = ellipsoid_change(
            model.link_fluid_shape[world, link], model.link_fluid_added[world, link], density, viscosity,
            spin, flow, more_spin, more_flow,
        )  # fmt: skip
    return found


@func
def velocity_change(
    space: StepSpace,
    steps: StepBatch,
    place: Int32,
    reach: Int32,
    other: Int32,
    point: Vector3,
    spin: Vector3,
):
    """How the angular velocity of a link and the velocity of its point change with a dof that moves it."""
    n = space.dofs
    own = place * n + other
    turn, shift = steps.axis_angular[own], steps.axis_linear[own]
    turned = Vector3(0.0, 0.0, 0.0)
    moved = wp.cross(spin, point_motion(steps, own, point))
    for index in range(reach):
        dof = steps.reach[place * n + index]
        if follows(space, dof, other):
            entry = place * n + dof
            rate = steps.velocity[3 * place * n + dof]
            axis, lift = steps.axis_angular[entry], steps.axis_linear[entry]
            spun = wp.cross(turn, axis)
            turned += rate * spun
            moved += rate * (wp.cross(turn, lift) + wp.cross(shift, axis) + wp.cross(spun, point))
    return turned, moved


@func
def add_link_changes(
    model: Model,
    state: State,
    space: StepSpace,
    steps: StepBatch,
    place: Int32,
    world: Int32,
    link: Int32,
):
    """Add the derivatives of the forces of the fluid on a link to those of all forces."""
    n = space.dofs
    reach = find_reach(model, space, steps, place, link, Int32(-1))
    pose = state.link_pose[world, link]
    centre = wp.transform_get_translation(pose)
    turn = rotation_matrix(wp.transform_get_rotation(pose))
    back = wp.transpose(turn)
    spin, velocity = Vector3(0.0, 0.0, 0.0), Vector3(0.0, 0.0, 0.0)
    for index in range(reach):
        dof = steps.reach[place * n + index]
        rate = steps.velocity[3 * place * n + dof]
        spin += rate * steps.axis_angular[place * n + dof]
        velocity += rate * point_motion(steps, place * n + dof, centre)
    wrench = fluid_wrench(model, world, link, turn, model.link_mass[world, link], spin, velocity)
    force, torque = Vector3(wrench[0], wrench[1], wrench[2]), Vector3(wrench[3], wrench[4], wrench[5])
    stream = velocity - model.fluid_wind[world, 0]
    about, along = back * spin, back * stream
    for rank in range(reach):
        other = steps.reach[place * n + rank]
        axis = steps.axis_angular[place * n + other]
        shift = point_motion(steps, place * n + other, centre)
        turned, moved = velocity_change(space, steps, place, reach, other, centre, spin)
        turned -= wp.cross(axis, spin)
        moved -= wp.cross(axis, stream)
        by_q = wrench_change(model, world, link, about, along, back * turned, back * moved)
        by_v = wrench_change(model, world, link, about, along, back * axis, back * shift)
        force_q = wp.cross(axis, force) + turn * Vector3(by_q[0], by_q[1], by_q[2])
        torque_q = wp.cross(axis, torque) + turn * Vector3(by_q[3], by_q[4], by_q[5])
        force_v = turn * Vector3(by_v[0], by_v[1], by_v[2])
        torque_v = turn * Vector3(by_v[3], by_v[4], by_v[5])
        for index in range(reach):
            dof = steps.reach[place * n + index]
            entry = place * n + dof
            found_q = end_change(
                space, steps, place, dof, other, True, centre, shift, force, force_q, Int32(0)
            )
            found_q += end_change(
                space, steps, place, dof, other, True, centre, shift, torque, torque_q, Int32(1)
            )
            found_v = wp.dot(point_motion(steps, entry, centre), force_v)
            found_v += wp.dot(steps.axis_angular[entry], torque_v)
            for end in range(2):
                target = ((2 * place + end) * n + dof) * space.columns + other
                steps.force[target] += found_q
                steps.force[target + n] += found_v


@func
def add_fluid_changes(
    model: Model,
    state: State,
    space: StepSpace,
    steps: StepBatch,
    place: Int32,
    world: Int32,
):
    """Add the derivatives of the forces of the fluid on all links, if there is any."""
    if model.fluid_density[world, 0] + model.fluid_viscosity[world, 0] > 0.0:
        last = Int32(-1)
        for dof in range(space.dofs):
            tree = space.dof_tree[dof]
            # Dofs of a tree follow each other.
            if tree != last:
                base = model.tree[tree].first_link
                for link in range(base, base + model.tree[tree].link_count):
                    add_link_changes(model, state, space, steps, place, world, link)
                last = tree + 0
