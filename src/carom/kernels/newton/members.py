"""The trees of an island that rows act on: places of their dofs, and their inertia."""

import warp as wp

from carom.kernels.dynamics.dynamics import turned_inertia
from carom.kernels.dynamics.single_body import is_single_body
from carom.kernels.maths.rotation import rotation_matrix
from carom.kernels.newton.assembly import mass_of_single, mass_of_tree
from carom.kernels.newton.envelope import clear_entries
from carom.kernels.solver.pair_rows import tree_blocks
from carom.kernels.structs import Model, NewtonWork, Scratch, State
from carom.kernels.types import Int32, func, real
from carom.layouts.newton import MEMBERS, PLACES

# Inertia of dofs that nothing can accelerate.
_IMMOVABLE = real(1e9)


@func
def place_of(model: Model, work: NewtonWork, world: Int32, tree: Int32) -> Int32:
    """The place of a tree's dofs; a tree without one becomes a member. 0 for the world and fixed bases."""
    blocks = tree_blocks(model, tree)
    if blocks == 0:
        return Int32(0)
    place = work.tree_place[world, tree] + 0
    if place < 0:
        place = work.count_newton[world, PLACES] + 0
        work.tree_place[world, tree] = place
        work.tree_member[world, work.count_newton[world, MEMBERS]] = tree
        work.count_newton[world, MEMBERS] = work.count_newton[world, MEMBERS] + 1
        work.count_newton[world, PLACES] = place + blocks
        for block in range(place, place + blocks):
            work.vector_last[world, block] = block
        # A dof has entries with all of its subtree: children pass on what they have.
        first = model.tree[tree].first_dof
        for i in range(model.tree[tree].dof_count):
            dof = first + model.tree[tree].dof_count - 1 - i
            parent = model.dof[dof].parent
            if parent >= 0:
                above = place + (parent - first) // 4
                end = work.vector_last[world, place + (dof - first) // 4]
                work.vector_last[world, above] = wp.max(work.vector_last[world, above], end)
        for block in range(place, place + blocks):
            work.vector_own[world, block] = work.vector_last[world, block]
    return place


@func
def write_single_mass(model: Model, state: State, work: NewtonWork, world: Int32, tree: Int32, place: Int32):
    """Write the inertia of a body of one link: angular dofs come first, then linear ones."""
    link = model.tree[tree].first_link
    rotation = rotation_matrix(wp.transform_get_rotation(state.link_pose[world, link]))
    inertia = turned_inertia(rotation, model.link_inertia[world, link])
    mass_of_single(work.matrix_mass, work.vector_start, world, place, inertia, model.link_mass[world, link])


@func
def write_masses(
    model: Model, state: State, scratch: Scratch, work: NewtonWork, world: Int32, entries: Int32
):
    """Write the inertia of all members, and the scale of their dofs."""
    clear_entries(work.matrix_mass, world, entries)
    for member in range(work.count_newton[world, MEMBERS]):
        tree = work.tree_member[world, member]
        place = work.tree_place[world, tree]
        if is_single_body(model, tree):
            write_single_mass(model, state, work, world, tree, place)
        else:
            mass_of_tree(
                work.matrix_mass, work.vector_start, scratch.mass_block, model.tree[tree].first_block,
                scratch.dof, model.tree[tree].first_dof, world, place, model.tree[tree].dof_count, _IMMOVABLE,
            )  # fmt: skip
    for i in range(4 * work.count_newton[world, PLACES]):
        block = 16 * (work.vector_start[world, i // 4] + i // 4)
        diagonal = work.matrix_mass[world, block + 5 * (i % 4)]
        work.vector_scale[world, i] = 1.0 / wp.sqrt(wp.max(diagonal, 1e-300))


@func
def add_changes(model: Model, scratch: Scratch, work: NewtonWork, world: Int32, with_impacts: Int32):
    """Write the solution into the changes of velocity of all members."""
    for member in range(work.count_newton[world, MEMBERS]):
        tree = work.tree_member[world, member]
        place = 4 * work.tree_place[world, tree]
        delta = 4 * model.tree[tree].first_delta
        for i in range(model.tree[tree].dof_count):
            change = work.vector_change[world, place + i]
            if with_impacts == 1:
                change += work.vector_total[world, place + i]
            scratch.entry_delta_velocity[world, delta + i] = change
