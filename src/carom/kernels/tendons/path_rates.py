"""How fast the velocity along a path changes while no joint accelerates: what its moment arms' rates add."""

import warp as wp

from carom.kernels.dynamics.kinematics import base_omega, base_velocity
from carom.kernels.structs import Model, Scratch, State, UserConstraints
from carom.kernels.tendons.paths import path_position
from carom.kernels.types import Int32, Vector3, func, real
from carom.layouts.codes import PATH_PULLEY, PATH_SITE

_TINY = real(1e-15)


@func
def steady_motion(
    model: Model,
    state: State,
    scratch: Scratch,
    world: Int32,
    tree: Int32,
    link: Int32,
    point: Vector3,
    h: real,
):
    """Velocity of a point of a link before a free motion of time `h`, and its acceleration.

    The acceleration is that at constant rates of joints and a constant velocity of the base.
    """
    zero = Vector3(0.0, 0.0, 0.0)
    if link < 0:
        return zero, zero
    base = model.tree[tree].first_link
    base_turn, base_speed = base_omega(model, state, world, tree), base_velocity(model, state, world, tree)
    if model.tree[tree].fixed == 0:
        first = model.tree[tree].first_dof
        for i in range(3):
            base_turn -= scratch.dof[world, first + i].angular * (h * scratch.dof[world, first + i].force)
            base_speed -= scratch.dof[world, first + 3 + i].linear * (
                h * scratch.dof[world, first + 3 + i].force
            )
    # All twists are those at the base; the motion of a link is the sum of those of the joints before it.
    omega, velocity = base_turn * real(1.0), base_speed * real(1.0)
    at = link + 0
    while at != base:
        for dof in range(model.link[at].first_dof, model.link[at].first_dof + model.link[at].dof_count):
            rate = state.dof_velocity[world, dof] - h * scratch.dof[world, dof].force
            omega += scratch.dof[world, dof].angular * rate
            velocity += scratch.dof[world, dof].linear * rate
        at = model.link[at].parent
    reach = point - wp.transform_get_translation(state.link_pose[world, base])
    point_velocity = velocity + wp.cross(omega, reach)
    acceleration = wp.cross(omega, point_velocity)
    if model.tree[tree].fixed == 0:
        acceleration -= wp.cross(base_turn, base_speed)
    at = link + 0
    while at != base:
        joint_omega, joint_velocity = zero * real(1.0), zero * real(1.0)
        for dof in range(model.link[at].first_dof, model.link[at].first_dof + model.link[at].dof_count):
            rate = state.dof_velocity[world, dof] - h * scratch.dof[world, dof].force
            joint_omega += scratch.dof[world, dof].angular * rate
            joint_velocity += scratch.dof[world, dof].linear * rate
        acceleration += wp.cross(omega, joint_velocity) + wp.cross(velocity, joint_omega)
        acceleration += wp.cross(wp.cross(omega, joint_omega), reach)
        omega -= joint_omega
        velocity -= joint_velocity
        at = model.link[at].parent
    return point_velocity, acceleration


@func
def path_acceleration(
    model: Model,
    state: State,
    scratch: Scratch,
    users: UserConstraints,
    world: Int32,
    tree: Int32,
    first: Int32,
    end: Int32,
    h: real,
) -> real:
    """Second derivative of the length of a path by time while no joint accelerates.

    That is before a free motion of time `h`. Joints have constant moment arms; what begins or ends on a
    sphere or cylinder counts as if it did.
    """
    zero = Vector3(0.0, 0.0, 0.0)
    total, divisor = real(0.0), real(1.0)
    link, started = Int32(-1), Int32(0)
    at, velocity, acceleration = zero * real(1.0), zero * real(1.0), zero * real(1.0)
    for part in range(first, end):
        kind = users.path_kind[part]
        if kind == PATH_PULLEY:
            divisor = users.path_size[part]
            started = Int32(0)
        elif kind == PATH_SITE:
            to = users.path_link[part]
            there = path_position(state, world, to, users.path_point[part])
            next_velocity, next_acceleration = steady_motion(model, state, scratch, world, tree, to, there, h)
            distance = wp.length(there - at)
            if started != 0 and distance > _TINY and to != link:
                along = (there - at) / distance
                apart = next_velocity - velocity
                rate = wp.dot(along, apart)
                across = wp.dot(apart, apart) - rate * rate
                total += (wp.dot(along, next_acceleration - acceleration) + across / distance) / divisor
            link = to
            at = there
            velocity = next_velocity
            acceleration = next_acceleration
            started = Int32(1)
        else:
            started = Int32(0)
    return total
