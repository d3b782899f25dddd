"""Free motion of bodies of one link, by the Newton-Euler equations.

The result is that of `dynamics` and `mass_matrix` for such a tree, but no matrix has to be factorised: the
inverse inertia is diagonal in the principal axes.
"""

import warp as wp

from carom.kernels.dynamics.dynamics import (
    damping_rate,
    external_force,
    external_torque,
    turned_inertia,
    update_velocities,
)
from carom.kernels.dynamics.fluid import fluid_wrench, has_fluid
from carom.kernels.dynamics.kinematics import base_omega, base_subspace, base_velocity, forward_kinematics
from carom.kernels.dynamics.quarantine import report_fault
from carom.kernels.dynamics.rows import inverse_moments_or_off, inverse_or_off
from carom.kernels.joints.coordinates import three_numbers
from carom.kernels.maths.rotation import rotation_matrix
from carom.kernels.structs import Model, Scratch, Settings, State
from carom.kernels.types import Int32, Matrix3, Vector3, Vector4, func, real


@func
def is_single_body(model: Model, tree: Int32) -> bool:
    """Whether a tree is a single link without a fixed base."""
    return model.tree[tree].link_count == 1 and model.tree[tree].fixed == 0


@func
def write_inverse_mass(
    model: Model, scratch: Scratch, world: Int32, tree: Int32, inverse_inertia: Matrix3, inverse_mass: real
):
    """Fill the inverse mass matrix of a body; its angular dofs come first, then the linear ones."""
    block = model.tree[tree].first_block
    none = Vector4(0.0, 0.0, 0.0, 0.0)
    for axis in range(3):
        row = inverse_inertia[axis]
        scratch.block_inverse_mass[world, block + 2 * axis] = Vector4(row[0], row[1], row[2], 0.0)
        scratch.block_inverse_mass[world, block + 2 * axis + 1] = none
    scratch.block_inverse_mass[world, block + 6] = Vector4(0.0, 0.0, 0.0, inverse_mass)
    scratch.block_inverse_mass[world, block + 7] = none
    scratch.block_inverse_mass[world, block + 8] = none
    scratch.block_inverse_mass[world, block + 9] = Vector4(inverse_mass, 0.0, 0.0, 0.0)
    scratch.block_inverse_mass[world, block + 10] = none
    scratch.block_inverse_mass[world, block + 11] = Vector4(0.0, inverse_mass, 0.0, 0.0)


@func
def move_single_body(
    model: Model, settings: Settings, state: State, scratch: Scratch, world: Int32, tree: Int32, pushed: bool
):
    """Update the velocities of a body for the substep without constraints; as `step.free_motion`."""
    forward_kinematics(model, state, state.link_pose, world, tree)
    link = model.tree[tree].first_link
    moments = model.link_inertia[world, link]
    mass = model.link_mass[world, link]
    inverse_mass = inverse_or_off(mass)
    rotation = rotation_matrix(wp.transform_get_rotation(state.link_pose[world, link]))
    inverse_inertia = turned_inertia(rotation, inverse_moments_or_off(moments))

    omega = base_omega(model, state, world, tree)
    velocity = base_velocity(model, state, world, tree)
    spin = turned_inertia(rotation, moments) * omega
    force = external_force(model, state, mass, world, link)
    torque = external_torque(state, world, link) - wp.cross(omega, spin)
    if has_fluid(model, world):
        wrench = fluid_wrench(model, world, link, rotation, mass, omega, velocity)
        force += Vector3(wrench[0], wrench[1], wrench[2])
        torque += Vector3(wrench[3], wrench[4], wrench[5])
    linear_damping = model.tree_linear_damping[world, tree]
    if linear_damping != 0.0:
        force -= velocity * (mass * damping_rate(linear_damping, wp.length(velocity)))
    angular_damping = model.tree_angular_damping[world, tree]
    if angular_damping != 0.0:
        torque -= spin * damping_rate(angular_damping, wp.length(omega))

    first = model.tree[tree].first_dof
    angular = inverse_inertia * (torque + three_numbers(state.dof_torque, world, first))
    linear = inverse_mass * (force + three_numbers(state.dof_torque, world, first + 3))
    for axis in range(3):
        scratch.dof[world, first + axis].force = angular[axis]
        scratch.dof[world, first + 3 + axis].force = linear[axis]
    update_velocities(model, settings, state, scratch, world, tree)
    # No force depends on the position of a single body, so a fault there does not reach its velocities.
    position = wp.transform_get_translation(state.link_pose[world, link])
    report_fault(state, world, tree, position[0] + position[1] + position[2])
    if pushed:
        base_subspace(model, scratch, world, tree)
        write_inverse_mass(model, scratch, world, tree, inverse_inertia, inverse_mass)
