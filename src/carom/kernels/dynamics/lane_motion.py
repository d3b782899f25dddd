"""Free motion of several worlds at once, each in a lane of vector registers.

The build compiles this module with a type of several numbers in place of `real` (`native/building/lanes.h`),
one for each world. So all arrays of numbers are those of `engine.lane_work`, without a world axis.
"""

from carom.kernels.dynamics.dynamics import generalized_forces, link_bias_forces, link_inertias
from carom.kernels.dynamics.fluid import add_fluid_forces, has_fluid
from carom.kernels.dynamics.joint_terms import add_joint_terms
from carom.kernels.dynamics.kinematics import forward_kinematics, motion_subspaces
from carom.kernels.dynamics.mass_matrix import composite_inertia, factorise, invert, keep_inertia, solve
from carom.kernels.dynamics.motors import explicit_pd, joint_damping
from carom.kernels.maths.lanes import in_some_world
from carom.kernels.structs import Model, Scratch, State
from carom.kernels.types import Int32, RealRows, func, kernel, real
from carom.layouts.codes import FREE_MOTION


@func
def accelerate_tree(model: Model, time_step: real, state: State, scratch: Scratch, world: Int32, tree: Int32):
    """Fill in poses and motion subspaces of a tree, its mass matrix, and the accelerations of free motion."""
    place_links(model, state, scratch, world, tree)
    link_bias_forces(model, state, scratch, world, tree, FREE_MOTION)
    accelerate_by_forces(model, time_step, state, scratch, world, tree)


@func
def place_links(model: Model, state: State, scratch: Scratch, world: Int32, tree: Int32):
    """Fill in poses, motion subspaces and inertias of the links of a tree."""
    forward_kinematics(model, state, state.link_pose, world, tree)
    motion_subspaces(model, state.link_pose, scratch, world, tree)
    link_inertias(model, scratch, world, tree)


@func
def accelerate_by_forces(
    model: Model, time_step: real, state: State, scratch: Scratch, world: Int32, tree: Int32
):
    """Fill in the mass matrix of a tree and its accelerations, from the force that each link needs."""
    if has_fluid(model, world):
        add_fluid_forces(model, scratch, world, tree)
    generalized_forces(model, state, scratch, world, tree, FREE_MOTION)
    composite_inertia(model, scratch, world, tree)
    if in_some_world(model.tree_joint_terms[world, tree] != 0.0):
        add_joint_terms(model, time_step, state, scratch, world, tree)
    keep_inertia(model, scratch, world, tree)
    factorise(model, scratch, world, tree)
    solve(model, scratch, world, tree)


@func
def has_several_links(model: Model, tree: Int32) -> bool:
    """Whether a tree has more than a base: only then does it save time to move several worlds at once."""
    return model.tree[tree].link_count > 1


@kernel
def lane_motion_kernel(model: Model, state: State, scratch: Scratch, time_steps: RealRows, tree_count: Int32):
    """Accelerations and inverse mass matrices of all trees of more than one link, at the start of a step."""
    for tree in range(tree_count):
        if has_several_links(model, tree):
            joint_damping(model, state, 0, tree)
            explicit_pd(model, state, 0, tree)
            accelerate_tree(model, time_steps[0, 0], state, scratch, 0, tree)
            invert(model, scratch, 0, tree)
