"""One step of a world: every stage in order, in one kernel launch."""

import warp as wp

from carom.model.codes import FREE_MOTION
from carom.model.contact_structs import Contacts, Couplings, Shapes, UserConstraints
from carom.model.real import Int32, Vector6, func, kernel
from carom.model.structs import Model, Scratch, Settings, State
from carom.physics.dynamics import generalized_forces, link_bias_forces, link_inertias, update_velocities
from carom.physics.feedback import (
    clear_constraint_forces,
    constraint_feedback,
    measure_joint_wrenches,
)
from carom.physics.integration import integrate_positions
from carom.physics.islands import build_islands
from carom.physics.kinematics import forward_kinematics, motion_subspaces
from carom.physics.mass_matrix import composite_inertia, factorise, invert, solve
from carom.physics.motors import explicit_pd, joint_damping
from carom.physics.quarantine import keep_start, return_to_start
from carom.physics.solver import apply_delta_velocities, clear_delta_velocities, solve_island


@func
def free_motion(
    model: Model,
    settings: Settings,
    state: State,
    scratch: Scratch,
    couplings: Couplings,
    world: Int32,
    tree: Int32,
):
    """Velocities after the substep if there were no constraints."""
    explicit_pd(model, state, world, tree)
    forward_kinematics(model, state, state.link_pose, world, tree)
    motion_subspaces(model, state.link_pose, scratch, world, tree)
    link_inertias(model, scratch, world, tree)
    link_bias_forces(model, settings, state, scratch, world, tree, FREE_MOTION)
    generalized_forces(model, state, scratch, world, tree, FREE_MOTION)
    composite_inertia(model, scratch, world, tree)
    factorise(model, scratch, world, tree)
    solve(model, scratch, world, tree)
    if model.tree[tree].sensor_count > 0:
        measure_joint_wrenches(model, settings, state, scratch, world, tree, 0)
        clear_constraint_forces(model, scratch, world, tree)
    update_velocities(model, settings, state, scratch, world, tree)
    if model.tree[tree].constraint_count > 0 or couplings.tree_touches[world, tree] != 0:
        invert(model, scratch, world, tree)
    clear_delta_velocities(model, scratch, world, tree)


@func
def clear_forces(model: Model, state: State, world: Int32, tree: Int32):
    """Applied forces and torques last for one step."""
    base = model.tree[tree].first_link
    for link in range(base, base + model.tree[tree].link_count):
        state.link_wrench[world, link] = Vector6()
    first = model.tree[tree].first_dof
    for dof in range(first, first + model.tree[tree].dof_count):
        state.dof_torque[world, dof] = 0.0


@func
def solve_constraints(
    settings: Settings,
    model: Model,
    state: State,
    scratch: Scratch,
    shapes: Shapes,
    contacts: Contacts,
    users: UserConstraints,
    couplings: Couplings,
    world: Int32,
):
    """Find the changes of velocity that motors, limits, user constraints and contacts ask for."""
    for tree in range(settings.tree_count):
        if state.tree_island[world, tree] == tree:
            solve_island(model, settings, state, scratch, shapes, contacts, users, couplings, world, tree)


@kernel
def step_kernel(
    settings: Settings,
    model: Model,
    state: State,
    scratch: Scratch,
    shapes: Shapes,
    contacts: Contacts,
    users: UserConstraints,
    couplings: Couplings,
    substeps: Int32,
    begins: Int32,
    ends: Int32,
):
    """Advance each world by `substeps` substeps of one step.

    Where bodies can touch, collision detection comes between substeps and each is a launch: then
    `begins` and `ends` tell the first and the last of a step.
    """
    world = wp.tid()
    if begins != 0:
        state.fault_tree[world, 0] = 0
        for tree in range(settings.tree_count):
            keep_start(model, state, scratch, world, tree)
            joint_damping(model, state, world, tree)

    for _substep in range(substeps):
        build_islands(settings, model, state, shapes, contacts, users, couplings, world)
        for tree in range(settings.tree_count):
            free_motion(model, settings, state, scratch, couplings, world, tree)
        solve_constraints(settings, model, state, scratch, shapes, contacts, users, couplings, world)
        for tree in range(settings.tree_count):
            if model.tree[tree].sensor_count > 0:
                constraint_feedback(model, settings, state, scratch, world, tree)
            apply_delta_velocities(model, state, scratch, world, tree)
            integrate_positions(model, state, world, tree, settings.time_step)

    fault = state.fault_tree[world, 0]
    for tree in range(settings.tree_count):
        if fault != 0:
            return_to_start(model, state, scratch, world, tree)
        if fault > 0 or (fault == 0 and ends != 0):
            clear_forces(model, state, world, tree)
