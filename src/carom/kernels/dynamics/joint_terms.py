"""Armature, damping and springs of joints: terms that are implicit in velocity.

The mass matrix of a tree with such terms is M + armature + h D + h² K, for its free motion and for all rows.
So damping and springs are stable however stiff they are, and constraints count with them.
"""

import warp as wp

from carom.kernels.dynamics.kinematics import load_quaternion
from carom.kernels.maths.rotation import rotation_vector
from carom.kernels.structs import Model, Scratch, State
from carom.kernels.types import Int32, Quaternion, Vector3, func, real
from carom.layouts.codes import PLANAR, SPHERICAL


@func
def spring_stretch(model: Model, state: State, world: Int32, link: Int32) -> Vector3:
    """By how much the spring of a joint is stretched, along each of its dofs [rad or m]."""
    q = model.link[link].first_position
    joint_type = model.link[link].joint_type
    if joint_type == SPHERICAL:
        rest = Quaternion(
            model.position_spring[world, q],
            model.position_spring[world, q + 1],
            model.position_spring[world, q + 2],
            model.position_spring[world, q + 3],
        )
        return rotation_vector(wp.quat_inverse(rest) * load_quaternion(state, world, q))
    first = state.position[world, q] - model.position_spring[world, q]
    if joint_type != PLANAR:
        return Vector3(first, 0.0, 0.0)
    # The rates of a planar joint are along axes of its link, which its angle turns.
    angle = state.position[world, q]
    x = state.position[world, q + 1] - model.position_spring[world, q + 1]
    y = state.position[world, q + 2] - model.position_spring[world, q + 2]
    cosine, sine = wp.cos(angle), wp.sin(angle)
    return Vector3(first, cosine * x - sine * y, sine * x + cosine * y)


@func
def add_joint_terms(model: Model, h: real, state: State, scratch: Scratch, world: Int32, tree: Int32):
    """Add the forces of damping and springs to `dof_force`, and the joints' terms to the mass matrix.

    `h` is the time of a substep.
    """
    first_of_tree = model.tree[tree].first_dof
    blocks = (model.tree[tree].dof_count + 3) // 4
    matrix = model.tree[tree].first_block
    base = model.tree[tree].first_link
    for i in range(model.link[base].dof_count):
        dof = model.link[base].first_dof + i
        damping = model.dof_implicit_damping[world, dof]
        scratch.dof[world, dof].force -= damping * state.dof_velocity[world, dof]
        place = dof - first_of_tree
        scratch.entry_factor[world, 4 * (matrix + place * blocks) + place] += (
            model.dof_armature[world, dof] + h * damping
        )
    for link in range(base + 1, base + model.tree[tree].link_count):
        count = model.link[link].dof_count
        if count > 0:
            first = model.link[link].first_dof
            stretch = spring_stretch(model, state, world, link)
            for i in range(count):
                dof = first + i
                damping = model.dof_implicit_damping[world, dof]
                stiffness = model.dof_stiffness[world, dof]
                yielding = damping + h * stiffness
                scratch.dof[world, dof].force -= (
                    yielding * state.dof_velocity[world, dof] + stiffness * stretch[i]
                )
                place = dof - first_of_tree
                scratch.entry_factor[world, 4 * (matrix + place * blocks) + place] += (
                    model.dof_armature[world, dof] + h * yielding
                )
