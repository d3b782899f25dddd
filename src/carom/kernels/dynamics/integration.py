"""Integration of positions, with the velocities at the end of the step (semi-implicit Euler)."""

import warp as wp

from carom.kernels.dynamics.kinematics import base_omega, base_velocity
from carom.kernels.joints.coordinates import load_quaternion, store_quaternion
from carom.kernels.joints.trees import integrate_joint
from carom.kernels.maths.rotation import rotation_step
from carom.kernels.structs import Model, State
from carom.kernels.types import Int32, func, real


@func
def integrate_positions(model: Model, state: State, world: Int32, tree: Int32, dt: real):
    """Integrate the coordinates of a tree over `dt`.

    Angular velocities of the base are in world axes; for joints see `integrate_joint`.
    """
    base = model.tree[tree].first_link
    q = model.tree[tree].first_position
    velocity = base_velocity(model, state, world, tree)
    omega = base_omega(model, state, world, tree)
    if wp.dot(velocity, velocity) + wp.dot(omega, omega) != 0.0:
        for axis in range(3):
            state.position[world, q + axis] += dt * velocity[axis]
        turn = rotation_step(omega, dt)
        store_quaternion(state, world, q + 3, turn * load_quaternion(state, world, q + 3))

    for link in range(base + 1, base + model.tree[tree].link_count):
        integrate_joint(model, state, world, link, dt)
