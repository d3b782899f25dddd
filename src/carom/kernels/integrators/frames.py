"""Free bases that move by the origins of their frames, as in MuJoCo, where the centre of mass is elsewhere.

Velocities in the state are those of the centre of mass, at c from the origin of the frame of the file.
MuJoCo's are those of that origin, and its integrators take them for constant along the axes of the world. So
does what follows, with u for the velocity of the centre of mass that the origin's velocity means at the
positions before the substep: free motion and all rows change u, by accelerations less ω x (ω x c), and at
the end the origin moves by u - ω' x c, with the turn by ω' after it.
"""

import warp as wp

from carom.kernels.dynamics.integration import integrate_positions
from carom.kernels.dynamics.kinematics import base_omega
from carom.kernels.joints.coordinates import load_quaternion
from carom.kernels.structs import Model, Scratch, State
from carom.kernels.types import Int32, Vector3, func, real


@func
def is_off_frame(model: Model, tree: Int32) -> bool:
    """Whether a base is free, and its centre of mass is not at the origin of its frame.

    `LinkModel.com_from_pivot` of a base is the centre of mass from that origin.
    """
    arm = model.link[model.tree[tree].first_link].com_from_pivot
    return model.tree[tree].fixed == 0 and wp.dot(arm, arm) > 0.0


@func
def arm_of_base(model: Model, state: State, world: Int32, tree: Int32) -> Vector3:
    """The centre of mass of a base from the origin of its frame, along the axes of the world [m]."""
    turn = wp.normalize(load_quaternion(state, world, model.tree[tree].first_position + 3))
    return wp.quat_rotate(turn, model.link[model.tree[tree].first_link].com_from_pivot)


@func
def carried_by_turning(omega: Vector3, arm: Vector3) -> Vector3:
    """Acceleration of the centre of mass where the frame turns steadily, and its origin has none [m/s²]."""
    return wp.cross(omega, wp.cross(omega, arm))


@func
def add_to_base(state: State, world: Int32, base: Int32, change: Vector3):
    """Change the linear velocity of a base, whose first velocity is `base`."""
    for axis in range(3):
        state.dof_velocity[world, base + 3 + axis] += change[axis]


@func
def leave_out_carried(
    model: Model, state: State, scratch: Scratch, world: Int32, tree: Int32, carried: Vector3, h: real
):
    """Take what turning carries a base along off the velocity and the acceleration of free motion.

    `DofScratch.free_acceleration` stays that of the centre of mass.
    """
    first = model.tree[tree].first_velocity
    for axis in range(3):
        scratch.dof[world, first + 3 + axis].force -= carried[axis]
    add_to_base(state, world, first, -h * carried)


@func
def integrate_by_frame(model: Model, state: State, world: Int32, tree: Int32, h: real):
    """As `integrate_positions`, by the velocity of the origin of the frame."""
    base = model.tree[tree].first_velocity
    q = model.tree[tree].first_position
    omega = base_omega(model, state, world, tree)
    before = arm_of_base(model, state, world, tree)
    add_to_base(state, world, base, -wp.cross(omega, before))
    integrate_positions(model, state, world, tree, h)
    after = arm_of_base(model, state, world, tree)
    for axis in range(3):
        state.position[world, q + axis] += after[axis] - before[axis]
    add_to_base(state, world, base, wp.cross(omega, after))
