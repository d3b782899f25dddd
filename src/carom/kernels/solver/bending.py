"""By how much rows of constraints turn: the accelerations that they have without any of joints, J̇ v."""

import warp as wp

from carom.kernels.dynamics.kinematics import base_omega
from carom.kernels.dynamics.single_body import is_single_body
from carom.kernels.integrators.frames import arm_of_base, carried_by_turning, is_off_frame
from carom.kernels.structs import Model, Scratch, Settings, State
from carom.kernels.types import Index4, Int32, Vector3, func


@func
def turning_of_link(
    model: Model, settings: Settings, state: State, scratch: Scratch, world: Int32, tree: Int32, link: Int32
) -> Vector3:
    """Angular velocity of a link before the free motion of this substep; 0 for the world, tree -1."""
    omega = Vector3(0.0, 0.0, 0.0)
    if tree >= 0:
        if is_single_body(model, tree):
            omega = base_omega(model, state, world, tree)
            first = model.tree[tree].first_dof
            for i in range(model.tree[tree].dof_count):
                change = settings.time_step * scratch.dof[world, first + i].force
                omega -= scratch.dof[world, first + i].angular * change
        else:
            omega = scratch.link[world, link].omega
    return omega


@func
def bending_of_point(
    model: Model, state: State, scratch: Scratch, world: Int32, tree: Int32, link: Int32, omega: Vector3,
    point: Vector3,
):  # fmt: skip
    """Acceleration of a point of a link whose joints, and base, have none, and its angular acceleration."""
    bent, alpha = Vector3(0.0, 0.0, 0.0), Vector3(0.0, 0.0, 0.0)
    if tree >= 0:
        origin = wp.transform_get_translation(state.link_pose[world, model.tree[tree].first_link])
        lever = point - origin
        if is_single_body(model, tree):
            bent = wp.cross(omega, wp.cross(omega, lever))
        else:
            alpha = scratch.link[world, link].alpha
            moved = scratch.link[world, link].velocity + wp.cross(omega, lever)
            bent = scratch.link[world, link].acceleration + wp.cross(alpha, lever) + wp.cross(omega, moved)
    return bent, alpha


@func
def carried_with_base(
    model: Model, settings: Settings, state: State, scratch: Scratch, world: Int32, tree: Int32
) -> Vector3:
    """Acceleration of the centre of mass of a base whose frame has none, see `integrators.frames`."""
    carried = Vector3(0.0, 0.0, 0.0)
    if tree >= 0:
        if is_off_frame(model, tree):
            base = model.tree[tree].first_link
            omega = turning_of_link(model, settings, state, scratch, world, tree, base)
            carried = carried_by_turning(omega, arm_of_base(model, state, world, tree))
    return carried


@func
def bending_between(
    model: Model, settings: Settings, state: State, scratch: Scratch, world: Int32, ends: Index4,
    point_a: Vector3, point_b: Vector3,
):  # fmt: skip
    """What J̇ v is between a point of a and one of b, along axes of the world, and about axes of a or of b.

    That of a base is without an acceleration of the origin of its frame where it moves by that.

    `ends` are tree and link of a, then of b. An axis of a turns with it, so that of (ωa - ωb) · axis the
    derivative without accelerations of joints is (αa - αb - ωb x ωa) · axis; of one of b it is the same.

    Returns:
        That along axes, that about axes, and the square of the relative angular velocity, |ωa - ωb|².
    """
    omega_a = turning_of_link(model, settings, state, scratch, world, ends[0], ends[1])
    omega_b = turning_of_link(model, settings, state, scratch, world, ends[2], ends[3])
    bent_a, alpha_a = bending_of_point(model, state, scratch, world, ends[0], ends[1], omega_a, point_a)
    bent_b, alpha_b = bending_of_point(model, state, scratch, world, ends[2], ends[3], omega_b, point_b)
    if settings.explicit_forces != 0:
        bent_a += carried_with_base(model, settings, state, scratch, world, ends[0])
        bent_b += carried_with_base(model, settings, state, scratch, world, ends[2])
    spin = omega_a - omega_b
    return bent_a - bent_b, alpha_a - alpha_b - wp.cross(omega_b, omega_a), wp.dot(spin, spin)
