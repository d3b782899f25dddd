"""Pushes: impulses of soft bodies on trees, as rows like the solver's, applied as soon as they are found.

Soft bodies move after the free motion of trees and before their constraints. A link is assumed to keep the
velocity that it had at the start of the substep, because whatever holds it (motors, contacts, limits) most
likely continues to do so. Changes of velocity by pushes are collected in `delta_velocity`, and added to the
velocities in the end. So the solver reacts to the pushes of a substep in the same substep.
"""

import warp as wp

from carom.kernels.dynamics.dynamics import turned_inertia
from carom.kernels.dynamics.kinematics import base_subspace
from carom.kernels.dynamics.mass_matrix import invert
from carom.kernels.dynamics.rows import inverse_moments_or_off, inverse_or_off
from carom.kernels.dynamics.single_body import is_single_body, write_inverse_mass
from carom.kernels.maths.rotation import rotation_matrix
from carom.kernels.solver.activity import is_left_out
from carom.kernels.solver.islands import may_be_pushed
from carom.kernels.solver.joint_solver import apply_delta_velocities, clear_delta_velocities
from carom.kernels.solver.pair_rows import push_row, row_velocity_change, tree_blocks, write_pair_jacobian
from carom.kernels.structs import Model, PairRows, Scratch, Settings, SoftWork, State
from carom.kernels.types import Index4, Int32, Matrix3, Vector3, func, real
from carom.layouts.soft import PUSH_ROWS
from carom.layouts.status import OVERFLOW, STATUS, WELL


@func
def keep_velocities(model: Model, state: State, work: SoftWork, world: Int32, tree: Int32):
    """Save the velocities of a tree at the start of a substep."""
    first = model.tree[tree].first_dof
    for dof in range(first, first + model.tree[tree].dof_count):
        work.dof_start[world, dof] = state.dof_velocity[world, dof]


@func
def exchange_velocities(settings: Settings, model: Model, state: State, work: SoftWork, world: Int32):
    """Swap the velocities of all trees with the saved ones; a second call swaps them back."""
    for tree in range(settings.tree_count):
        first = model.tree[tree].first_dof
        for dof in range(first, first + model.tree[tree].dof_count):
            velocity = state.dof_velocity[world, dof]
            state.dof_velocity[world, dof] = work.dof_start[world, dof]
            work.dof_start[world, dof] = velocity


@func
def can_be_pushed(model: Model, state: State, world: Int32, tree: Int32, link: Int32) -> bool:
    """Whether pushes can move a link: it has degrees of freedom and is awake. Tree -1 is the world."""
    if tree < 0:
        return False
    return model.link[link].nearest_dof >= 0 and not is_left_out(state, world, tree)


@func
def make_ready(
    model: Model,
    state: State,
    scratch: Scratch,
    pair_rows: PairRows,
    work: SoftWork,
    world: Int32,
    tree: Int32,
):
    """Compute a tree's inverse mass matrix, once in a substep, unless free motion has already done so."""
    if work.tree_ready[world, tree] == 0:
        work.tree_ready[world, tree] = 1
        if not may_be_pushed(model, pair_rows, world, tree):
            if is_single_body(model, tree):
                link = model.tree[tree].first_link
                inverse = inverse_moments_or_off(model.link_inertia[world, link])
                rotation = rotation_matrix(wp.transform_get_rotation(state.link_pose[world, link]))
                base_subspace(model, scratch, world, tree)
                write_inverse_mass(
                    model, scratch, world, tree, turned_inertia(rotation, inverse),
                    inverse_or_off(model.link_mass[world, link]),
                )  # fmt: skip
            else:
                invert(model, scratch, world, tree)


@func
def add_push_rows(
    model: Model,
    state: State,
    scratch: Scratch,
    pair_rows: PairRows,
    world: Int32,
    tree: Int32,
    link: Int32,
    point: Vector3,
    axes: Matrix3,
    row: Int32,
    block: Int32,
):
    """Add three rows that push a link at a point [m] in world axes along the columns of `axes`.

    Returns:
        Next free row and block; if there was no room, the given ones, and an overflow in the world's status.
    """
    if (
        row + PUSH_ROWS > pair_rows.row_start.shape[1]
        or block + PUSH_ROWS * tree_blocks(model, tree) > pair_rows.jacobian_row.shape[1]
    ):
        state.status_entry[world, STATUS] = OVERFLOW
        return row, block
    for i in range(PUSH_ROWS):
        direction = Vector3(axes[0, i], axes[1, i], axes[2, i])
        inverse_mass, _velocity, block = write_pair_jacobian(
            model, state, scratch, pair_rows, world, row, block, Index4(tree, link, -1, -1), point, point,
            direction, Vector3(0.0, 0.0, 0.0),
        )  # fmt: skip
        pair_rows.row_terms[world, row].inverse_mass = inverse_mass
        row += 1
    return row, block


@func
def row_mass(pair_rows: PairRows, world: Int32, row: Int32) -> real:
    """Effective inverse mass along a row [1/kg]; 0 for row -1, that of an immovable link."""
    return 0.0 if row < 0 else pair_rows.row_terms[world, row].inverse_mass


@func
def row_velocity(scratch: Scratch, pair_rows: PairRows, world: Int32, row: Int32) -> real:
    """Change of velocity along a row by all pushes so far [m/s]; 0 for row -1."""
    if row < 0:
        return 0.0
    return row_velocity_change(
        scratch, pair_rows, world, pair_rows.row_place[world, row], pair_rows.row_start[world, row]
    )


@func
def push_along(scratch: Scratch, pair_rows: PairRows, world: Int32, row: Int32, impulse: real):
    """Apply an impulse along a row [N s]; no effect for row -1."""
    if row >= 0:
        push_row(
            scratch, pair_rows, world, pair_rows.row_place[world, row],
            pair_rows.row_start[world, row], impulse,
        )  # fmt: skip


@func
def take_over_pushes(settings: Settings, model: Model, state: State, scratch: Scratch, world: Int32):
    """Add the changes of velocity by pushes to the velocities of trees."""
    for tree in range(settings.tree_count):
        if model.tree[tree].dof_count > 0 and not is_left_out(state, world, tree):
            if state.status_entry[world, STATUS] == WELL:
                apply_delta_velocities(model, state, scratch, world, tree)
            clear_delta_velocities(model, scratch, world, tree)
