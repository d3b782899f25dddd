"""Late velocities of links, as PyBullet has them for bodies loaded with `URDF_GLOBAL_VELOCITIES_MB`.

Gyroscopic, centripetal and Coriolis forces of the links, and their damping, are computed from velocities of
the substep before, 0 in the first one; those of the base are always those of the moment.
`State.late_velocity` and `State.late_joint` keep them, in world axes, with a row for each link but the base.
They are those after free motion: by the rates that joints then have, and by the velocity that the base had
before it.
"""

import warp as wp

from carom.kernels.dynamics.dynamics import write_link_force
from carom.kernels.dynamics.kinematics import base_omega, base_velocity, link_velocities
from carom.kernels.structs import Model, Scratch, State
from carom.kernels.types import Int32, Vector3, Vector6, func


@func
def late_bias_forces(model: Model, state: State, scratch: Scratch, world: Int32, tree: Int32, purpose: Int32):
    """As `link_bias_forces`, by the late velocities of the links; in the workspace are their true ones."""
    base = model.tree[tree].first_link
    linear_damping = model.tree_linear_damping[world, tree]
    angular_damping = model.tree_angular_damping[world, tree]
    link_velocities(model, state, scratch, world, tree)

    omega = base_omega(model, state, world, tree)
    velocity = base_velocity(model, state, world, tree)
    alpha, acceleration = Vector3(0.0, 0.0, 0.0), Vector3(0.0, 0.0, 0.0)
    if model.tree[tree].fixed == 0:
        acceleration = -wp.cross(omega, velocity)
    for link in range(base, base + model.tree[tree].link_count):
        if link > base:
            # Velocities of centres of mass are kept, those of the points at the reference are needed.
            c = scratch.link[world, link].offset
            late = state.late_velocity[world, model.tree[tree].first_late + link - base - 1]
            omega = Vector3(late[3], late[4], late[5])
            velocity = Vector3(late[0], late[1], late[2]) - wp.cross(omega, c)
            part = state.late_joint[world, model.tree[tree].first_late + link - base - 1]
            joint_omega = Vector3(part[3], part[4], part[5])
            joint_velocity = Vector3(part[0], part[1], part[2]) - wp.cross(joint_omega, c)
            parent = model.link[link].parent
            alpha = scratch.link[world, parent].alpha + wp.cross(omega, joint_omega)
            acceleration = scratch.link[world, parent].acceleration + wp.cross(omega, joint_velocity)
            acceleration += wp.cross(velocity, joint_omega)
        scratch.link[world, link].alpha = alpha
        scratch.link[world, link].acceleration = acceleration
        write_link_force(
            model, state, scratch, world, tree, link, purpose, omega, velocity, alpha, acceleration,
            linear_damping, angular_damping,
        )  # fmt: skip


@func
def keep_late_velocities(model: Model, state: State, scratch: Scratch, world: Int32, tree: Int32):
    """Keep the velocities of links for the next substep.

    They are by the present rates of joints, and by the velocity of the base in the workspace.
    """
    base = model.tree[tree].first_link
    for link in range(base + 1, base + model.tree[tree].link_count):
        parent = model.link[link].parent
        joint_omega, joint_velocity = Vector3(0.0, 0.0, 0.0), Vector3(0.0, 0.0, 0.0)
        first = model.link[link].first_dof
        for dof in range(first, first + model.link[link].dof_count):
            rate = state.dof_velocity[world, dof]
            joint_omega += scratch.dof[world, dof].angular * rate
            joint_velocity += scratch.dof[world, dof].linear * rate
        omega = scratch.link[world, parent].omega + joint_omega
        velocity = scratch.link[world, parent].velocity + joint_velocity
        scratch.link[world, link].omega = omega
        scratch.link[world, link].velocity = velocity
        c = scratch.link[world, link].offset
        late = model.tree[tree].first_late + link - base - 1
        state.late_velocity[world, late] = spatial(velocity + wp.cross(omega, c), omega)
        state.late_joint[world, late] = spatial(joint_velocity + wp.cross(joint_omega, c), joint_omega)


@func
def spatial(linear: Vector3, angular: Vector3) -> Vector6:
    """Both velocities in one row."""
    return Vector6(linear[0], linear[1], linear[2], angular[0], angular[1], angular[2])


@func
def keep_late_start(model: Model, state: State, scratch: Scratch, world: Int32, tree: Int32):
    """Save the late velocities of a tree at the start of a step."""
    first, last = model.tree[tree].first_late, model.tree[tree].first_late + model.tree[tree].late_count
    for late in range(first, last):
        scratch.late_velocity_start[world, late] = state.late_velocity[world, late]
        scratch.late_joint_start[world, late] = state.late_joint[world, late]


@func
def return_to_late_start(model: Model, state: State, scratch: Scratch, world: Int32, tree: Int32):
    """Restore the late velocities of a tree at the start of the step."""
    first, last = model.tree[tree].first_late, model.tree[tree].first_late + model.tree[tree].late_count
    for late in range(first, last):
        state.late_velocity[world, late] = scratch.late_velocity_start[world, late]
        state.late_joint[world, late] = scratch.late_joint_start[world, late]
