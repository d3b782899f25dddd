"""Armature, damping and springs of joints: terms that are implicit in velocity.

The mass matrix of a tree with such terms is M + armature + h D + h² K, for its free motion and for all rows.
So damping and springs are stable however stiff they are, and constraints count with them.
"""

import warp as wp

from carom.kernels.joints.coordinates import load_quaternion
from carom.kernels.joints.trees import spring_stretch
from carom.kernels.maths.lanes import in_some_world
from carom.kernels.maths.rotation import rotation_vector
from carom.kernels.structs import Model, Scratch, State
from carom.kernels.types import Int32, Quaternion, Vector3, func, real


@func
def base_stretch(model: Model, state: State, world: Int32, tree: Int32):
    """Angle and distance of a free base from the rest of its spring, in world axes [rad, m]."""
    q = model.tree[tree].first_position
    rest = Quaternion(
        model.position_spring[world, q + 3],
        model.position_spring[world, q + 4],
        model.position_spring[world, q + 5],
        model.position_spring[world, q + 6],
    )
    turn = load_quaternion(state, world, q + 3)
    # The axis of the turn from rest is the same in the axes at rest and in those of the base.
    angle = wp.quat_rotate(turn, rotation_vector(wp.quat_inverse(rest) * turn))
    distance = Vector3(
        state.position[world, q] - model.position_spring[world, q],
        state.position[world, q + 1] - model.position_spring[world, q + 1],
        state.position[world, q + 2] - model.position_spring[world, q + 2],
    )
    return angle, distance


@func
def add_joint_terms(model: Model, h: real, state: State, scratch: Scratch, world: Int32, tree: Int32):
    """Add the forces of damping and springs to `dof_force`, and the joints' terms to the mass matrix.

    `h` is the time of a substep.
    """
    first_of_tree = model.tree[tree].first_dof
    blocks = (model.tree[tree].dof_count + 3) // 4
    matrix = model.tree[tree].first_block
    base = model.tree[tree].first_link
    first_of_base = model.link[base].first_dof
    if model.link[base].dof_count > 0:
        if in_some_world(model.dof_stiffness[world, first_of_base] > 0.0):
            angle, distance = base_stretch(model, state, world, tree)
            for axis in range(3):
                turning = first_of_base + axis
                stiffness = model.dof_stiffness[world, turning]
                scratch.dof[world, turning].force -= wp.where(
                    stiffness > 0.0, stiffness * angle[axis], real(0.0)
                )
                moving = first_of_base + 3 + axis
                stiffness = model.dof_stiffness[world, moving]
                scratch.dof[world, moving].force -= wp.where(
                    stiffness > 0.0, stiffness * distance[axis], real(0.0)
                )
    for i in range(model.link[base].dof_count):
        dof = first_of_base + i
        yielding = model.dof_implicit_damping[world, dof] + h * model.dof_stiffness[world, dof]
        scratch.dof[world, dof].force -= yielding * state.dof_velocity[world, dof]
        place = dof - first_of_tree
        scratch.entry_factor[world, 4 * (matrix + place * blocks) + place] += (
            model.dof_armature[world, dof] + h * yielding
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
