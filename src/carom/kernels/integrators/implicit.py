"""Velocities at the end of a substep where damping counts implicitly: MuJoCo's Euler, implicitfast, implicit.

Constraints are solved with explicit forces and M. The change of velocity that results, Δv = h M⁻¹ (τ − c +
Jᵀf), becomes the solution of (M − h ∂(τ − c)/∂v) Δv' = M Δv.
"""

import warp as wp

from carom.kernels.dynamics.actuators import advance_activations
from carom.kernels.dynamics.feedback import constraint_feedback
from carom.kernels.dynamics.integration import integrate_positions
from carom.kernels.dynamics.lane_motion import accelerate_tree, place_links
from carom.kernels.dynamics.mass_matrix import composite_inertia
from carom.kernels.dynamics.quarantine import report_fault
from carom.kernels.dynamics.single_body import is_single_body
from carom.kernels.integrators.stages import end_of_dofs, to_world_axes
from carom.kernels.integrators.velocity_terms import add_joint_dampings, add_rotation_terms, add_user_terms
from carom.kernels.maths.min_max import within_bounds
from carom.kernels.maths.runs import copy_run
from carom.kernels.solver.activity import is_absent, is_left_out, stop_with_base
from carom.kernels.solver.joint_solver import apply_delta_velocities
from carom.kernels.solver.link_forces import gather_link_forces
from carom.kernels.structs import (
    Contacts,
    Model,
    PairRows,
    Scratch,
    Settings,
    Shapes,
    StageWork,
    State,
    UserConstraints,
)
from carom.kernels.types import Int32, called_func, func, kernel, real
from carom.layouts.newton import EULER, IMPLICIT


@func
def write_full_mass(
    model: Model,
    settings: Settings,
    state: State,
    scratch: Scratch,
    users: UserConstraints,
    pair_rows: PairRows,
    world: Int32,
    tree: Int32,
):
    """Write M with armature, of joints and tendons, in all entries of `entry_inverse_mass`."""
    first = model.tree[tree].first_dof
    n = model.tree[tree].dof_count
    blocks = (n + 3) // 4
    matrix = model.tree[tree].first_block
    place_links(model, state, scratch, world, tree)
    composite_inertia(model, scratch, world, tree)
    for i in range(n):
        for j in range(i + 1):
            entry = scratch.entry_factor[world, 4 * (matrix + i * blocks) + j] + 0.0
            if i == j:
                entry += model.dof_armature[world, first + i]
            scratch.entry_inverse_mass[world, 4 * (matrix + i * blocks) + j] = entry
            scratch.entry_inverse_mass[world, 4 * (matrix + j * blocks) + i] = entry
    add_user_terms(model, settings, state, scratch, users, pair_rows, world, tree, real(1.0), real(0.0))


@func
def solve_full(model: Model, scratch: Scratch, world: Int32, tree: Int32):
    """Replace the forces of the dofs by the solution of the equations in `entry_inverse_mass`.

    By elimination from the last dof on, so that trees cause no fill-in.
    """
    first = model.tree[tree].first_dof
    n = model.tree[tree].dof_count
    blocks = (n + 3) // 4
    start = 4 * model.tree[tree].first_block
    for step in range(n):
        k = n - 1 - step
        pivot = scratch.entry_inverse_mass[world, start + 4 * k * blocks + k]
        inverse = real(0.0)
        if pivot != 0.0:
            inverse = 1.0 / pivot
        for i in range(k):
            factor = scratch.entry_inverse_mass[world, start + 4 * i * blocks + k] * inverse
            if factor != 0.0:
                for j in range(k):
                    scratch.entry_inverse_mass[world, start + 4 * i * blocks + j] -= (
                        factor * scratch.entry_inverse_mass[world, start + 4 * k * blocks + j]
                    )
                scratch.dof[world, first + i].force -= factor * scratch.dof[world, first + k].force
    for k in range(n):
        total = scratch.dof[world, first + k].force + 0.0
        for j in range(k):
            total -= (
                scratch.entry_inverse_mass[world, start + 4 * k * blocks + j]
                * scratch.dof[world, first + j].force
            )
        pivot = scratch.entry_inverse_mass[world, start + 4 * k * blocks + k]
        inverse = real(0.0)
        if pivot != 0.0:
            inverse = 1.0 / pivot
        scratch.dof[world, first + k].force = total * inverse


@called_func
def count_damping(
    model: Model,
    settings: Settings,
    state: State,
    scratch: Scratch,
    users: UserConstraints,
    pair_rows: PairRows,
    work: StageWork,
    world: Int32,
    tree: Int32,
    kind: Int32,
):
    """Correct the velocities of a tree, which explicit forces have led to."""
    h = settings.time_step
    first = model.tree[tree].first_dof
    n = model.tree[tree].dof_count
    blocks = (n + 3) // 4
    start = 4 * model.tree[tree].first_block
    base = model.tree[tree].first_velocity
    count = end_of_dofs(model, tree) - base
    copy_run(work.dof_rate, state.dof_velocity, base, world, count)
    copy_run(state.dof_velocity, work.dof_first, base, world, count)
    to_world_axes(model, state, world, tree)
    for i in range(n):
        work.dof_change[world, first + i] = (
            work.dof_rate[world, first + i] - state.dof_velocity[world, first + i]
        )
    write_full_mass(model, settings, state, scratch, users, pair_rows, world, tree)
    for i in range(n):
        total = real(0.0)
        for j in range(n):
            total += (
                scratch.entry_inverse_mass[world, start + 4 * i * blocks + j]
                * work.dof_change[world, first + j]
            )
        work.dof_rate[world, first + i] = total
    add_joint_dampings(model, settings, state, scratch, world, tree, kind != EULER, h)
    if kind != EULER:
        add_user_terms(model, settings, state, scratch, users, pair_rows, world, tree, real(0.0), h)
    # As in MuJoCo, rotations of a lone free body are implicit in any case.
    if kind == IMPLICIT or (kind != EULER and is_single_body(model, tree)):
        add_rotation_terms(model, state, scratch, world, tree, h)
    for i in range(n):
        scratch.dof[world, first + i].force = work.dof_rate[world, first + i]
    solve_full(model, scratch, world, tree)
    for i in range(n):
        work.dof_change[world, first + i] = scratch.dof[world, first + i].force
    if model.tree[tree].sensor_count > 0:
        # Loads are found from the forces and factors of free motion, which are overwritten.
        accelerate_tree(model, real(0.0), state, scratch, world, tree)
    bound = model.tree_max_velocity[world, tree]
    sum_of_velocities = real(0.0)
    for i in range(n):
        velocity = state.dof_velocity[world, first + i] + work.dof_change[world, first + i]
        state.dof_velocity[world, first + i] = within_bounds(velocity, -bound, bound)
        sum_of_velocities += velocity
    # What a base without dofs was given moves it as ever.
    for dof in range(base, first):
        state.dof_velocity[world, dof] = work.dof_rate[world, dof]
    report_fault(state, world, tree, sum_of_velocities)


@kernel
def implicit_integration_kernel(
    settings: Settings,
    model: Model,
    state: State,
    scratch: Scratch,
    shapes: Shapes,
    contacts: Contacts,
    users: UserConstraints,
    pair_rows: PairRows,
    stage_work: StageWork,
    first_world: Int32,
    kind: Int32,
):
    """Add delta velocities to the velocities, count damping, and integrate positions.

    `kind` is `EXPLICIT`, `EULER`, `IMPLICIT_FAST` or `IMPLICIT` of `layouts.newton`.
    """
    world = first_world + wp.tid()
    for tree in range(settings.tree_count):
        gather_link_forces(settings, model, state, scratch, shapes, contacts, users, world, tree)
        if is_left_out(state, world, tree):
            if not is_absent(state, world, tree):
                stop_with_base(model, state, world, tree)
        else:
            if model.tree[tree].sensed_count > 0:
                constraint_feedback(model, settings, state, scratch, world, tree)
            apply_delta_velocities(model, state, scratch, world, tree)
            if model.tree[tree].dof_count > 0 and (
                kind > EULER or (kind == EULER and model.tree_joint_terms[world, tree] != 0.0)
            ):
                count_damping(
                    model, settings, state, scratch, users, pair_rows, stage_work, world, tree, kind
                )
            if model.tree[tree].actuator_count > 0:
                advance_activations(model, settings, state, world, tree)
            integrate_positions(model, state, world, tree, settings.time_step)
