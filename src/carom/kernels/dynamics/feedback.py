"""Force-torque sensors: the wrench that a joint transmits from the parent link to its link.

As in Bullet it is computed in two passes: the wrench of the unconstrained motion, plus that of a
second motion caused by the constraint forces alone.

Bullet's second pass has terms of the velocities of the links, which are in the first pass already: its
`State.link_reaction` is in error by the order of centripetal forces. And there the forces of a prismatic
joint's rows act on both centres of mass, which together is a torque on all links before it. `State.link_load`
is the sum of the first pass and of a second one in which both forces act at one point.
"""

import warp as wp

from carom.kernels.dynamics.dynamics import generalized_forces, link_bias_forces, parallel_axis
from carom.kernels.dynamics.mass_matrix import solve
from carom.kernels.dynamics.rows import row_dof
from carom.kernels.structs import Model, Scratch, Settings, State
from carom.kernels.types import Int32, Vector3, Vector6, func, real
from carom.layouts.codes import CONSTRAINT_FEEDBACK, LIMIT, LOADED, SPHERICAL_LIMIT

# Passes of `measure_joint_wrenches`.
FIRST, BULLETS, EXACT = 0, 1, 2


@func
def clear_constraint_forces(model: Model, state: State, scratch: Scratch, world: Int32, tree: Int32):
    """Set the impulses of the rows of a tree's joints, and the constraint forces on its links, to zero."""
    dof = model.tree[tree].first_dof + 0
    while dof < model.tree[tree].first_dof + model.tree[tree].dof_count:
        state.dof_joint_impulse[world, dof] = real(0.0)
        state.dof_limit_impulse[world, dof] = real(0.0)
        scratch.dof[world, dof].coupling = real(0.0)
        dof += 1
    scratch.tree[world, tree].is_pushed = 0
    if model.tree[tree].sensed_count > 0:
        clear_link_forces(model, scratch, world, tree)


@func
def clear_link_forces(model: Model, scratch: Scratch, world: Int32, tree: Int32):
    """Set the constraint forces on the links of a tree to zero."""
    base = model.tree[tree].first_link
    for link in range(base, base + model.tree[tree].link_count):
        scratch.link[world, link].constraint_force = Vector3(0.0, 0.0, 0.0)
        scratch.link[world, link].constraint_torque = Vector3(0.0, 0.0, 0.0)
        scratch.link[world, link].slide_torque = Vector3(0.0, 0.0, 0.0)


@func
def note_push(model: Model, scratch: Scratch, world: Int32, tree: Int32):
    """Prepare the constraint forces on the links of a tree for those of contacts and user constraints."""
    if scratch.tree[world, tree].is_pushed == 0:
        # Of a tree without Bullet's sensors they are cleared only here: most steps need none.
        if model.tree[tree].sensed_count == 0:
            clear_link_forces(model, scratch, world, tree)
        scratch.tree[world, tree].is_pushed = 1


@func
def add_link_force(state: State, scratch: Scratch, world: Int32, link: Int32, point: Vector3, force: Vector3):
    """Add a force [N] at a point of a link [m], in world axes, to the constraint forces of the substep."""
    center = wp.transform_get_translation(state.link_pose[world, link])
    scratch.link[world, link].constraint_force += force
    scratch.link[world, link].constraint_torque += wp.cross(point - center, force)


@func
def add_slide_torque(scratch: Scratch, world: Int32, link: Int32, parent: Int32, force: Vector3):
    """Let a force on a slide act on its parent at the centre of mass of the link, not of the parent."""
    arm = scratch.link[world, link].offset - scratch.link[world, parent].offset
    scratch.link[world, parent].slide_torque -= wp.cross(arm, force)


@func
def gather_constraint_forces(
    model: Model, settings: Settings, state: State, scratch: Scratch, world: Int32, first: Int32, last: Int32
):
    """Add the impulses of rows [first, last) to those of joints.

    For Bullet's force-torque sensors they are added to the links they join as well, as forces.
    """
    for row in range(first, last):
        constraint = scratch.row[world, row].constraint
        tree = model.constraint[constraint].tree
        if model.tree[tree].sensor_count > 0:
            link = model.constraint[constraint].link
            parent = model.link[link].parent
            dof = row_dof(model, scratch, world, row)
            impulse = scratch.row[world, row].impulse
            state.dof_joint_impulse[world, dof] += impulse
            kind = model.constraint[constraint].kind
            if kind == LIMIT or kind == SPHERICAL_LIMIT:
                state.dof_limit_impulse[world, dof] += impulse
            if model.tree[tree].sensed_count > 0:
                add_row_force(scratch, world, link, parent, dof, impulse / settings.time_step)


@func
def add_row_force(scratch: Scratch, world: Int32, link: Int32, parent: Int32, dof: Int32, size: real):
    """Add the force or torque of a row along a dof to its link, and the opposite to the parent."""
    angular = scratch.dof[world, dof].angular
    if wp.dot(angular, angular) > 0.0:
        scratch.link[world, link].constraint_torque += angular * size
        scratch.link[world, parent].constraint_torque -= angular * size
    else:
        linear = scratch.dof[world, dof].linear
        scratch.link[world, link].constraint_force += linear * size
        scratch.link[world, parent].constraint_force -= linear * size
        add_slide_torque(scratch, world, link, parent, linear * size)


@func
def measure_joint_wrenches(
    model: Model, settings: Settings, state: State, scratch: Scratch, world: Int32, tree: Int32, which: Int32
):
    """Store in (or add to) the sensors the wrenches transmitted by their joints.

    `which` is FIRST for the first pass, BULLETS or EXACT for one of the second passes. Expects the
    accelerations in `dof_force` and the link forces summed up by `generalized_forces`.
    """
    base = model.tree[tree].first_link
    count = model.tree[tree].link_count
    zero = Vector3(0.0, 0.0, 0.0)

    # Accelerations of the links caused by the joint accelerations.
    for link in range(base, base + count):
        alpha = zero
        acceleration = zero
        if link > base:
            alpha = scratch.link[world, model.link[link].parent].alpha
            acceleration = scratch.link[world, model.link[link].parent].acceleration
        first = model.link[link].first_dof
        for dof in range(first, first + model.link[link].dof_count):
            rate = scratch.dof[world, dof].force
            alpha += scratch.dof[world, dof].angular * rate
            acceleration += scratch.dof[world, dof].linear * rate
        scratch.link[world, link].alpha = alpha
        scratch.link[world, link].acceleration = acceleration

    # The forces needed for these, summed up towards the root and added to the bias forces.
    for link in range(base, base + count):
        mass = model.link_mass[world, link]
        c = scratch.link[world, link].offset
        alpha = scratch.link[world, link].alpha
        acceleration = scratch.link[world, link].acceleration
        inertia = scratch.link[world, link].com_inertia + mass * parallel_axis(c)
        force = mass * (acceleration + wp.cross(alpha, c))
        moment = inertia * alpha + mass * wp.cross(c, acceleration)
        up = link
        while up >= 0:
            scratch.link[world, up].force += force
            scratch.link[world, up].moment += moment
            up = model.link[up].parent

    for link in range(base + 1, base + count):
        if model.link[link].sensor != 0:
            force = scratch.link[world, link].force
            torque = scratch.link[world, link].moment - wp.cross(scratch.link[world, link].offset, force)
            to_link = wp.transpose(scratch.link[world, link].rotation)
            force, torque = to_link * force, to_link * torque
            load = Vector6(force[0], force[1], force[2], torque[0], torque[1], torque[2])
            if which == FIRST:
                state.link_load[world, link] = load
            elif which == EXACT:
                state.link_load[world, link] += load
            if settings.feedback_in_joint != 0:
                torque -= wp.cross(force, model.link[link].com_from_pivot)
            if settings.feedback_in_world != 0:
                force = scratch.link[world, link].rotation * force
                torque = scratch.link[world, link].rotation * torque
            wrench = Vector6(force[0], force[1], force[2], torque[0], torque[1], torque[2])
            if which == BULLETS:
                wrench += state.link_reaction[world, link]
            if which != EXACT:
                state.link_reaction[world, link] = wrench


@func
def has_loads(model: Model, tree: Int32) -> bool:
    """Whether some link of a tree needs `State.link_load`."""
    base = model.tree[tree].first_link
    for link in range(base, base + model.tree[tree].link_count):
        if (model.link[link].sensor & LOADED) != 0:
            return True
    return False


@func
def resting_link_forces(model: Model, scratch: Scratch, world: Int32, tree: Int32):
    """The force each link needs, as `link_bias_forces`, if it is at rest and only constraints act on it."""
    base = model.tree[tree].first_link
    for link in range(base, base + model.tree[tree].link_count):
        force = -scratch.link[world, link].constraint_force
        scratch.link[world, link].force = force
        torque = -(scratch.link[world, link].constraint_torque + scratch.link[world, link].slide_torque)
        scratch.link[world, link].moment = torque + wp.cross(scratch.link[world, link].offset, force)


@func
def constraint_feedback(
    model: Model, settings: Settings, state: State, scratch: Scratch, world: Int32, tree: Int32
):
    """Second pass: add the wrenches caused by constraint forces to the sensors."""
    add_exact_loads(model, settings, state, scratch, world, tree)
    link_bias_forces(model, state, scratch, world, tree, CONSTRAINT_FEEDBACK)
    add_bullets_loads(model, settings, state, scratch, world, tree)


@func
def add_exact_loads(
    model: Model, settings: Settings, state: State, scratch: Scratch, world: Int32, tree: Int32
):
    """Add what constraint forces cause without Bullet's errors, where some sensor needs it."""
    if has_loads(model, tree):
        resting_link_forces(model, scratch, world, tree)
        generalized_forces(model, state, scratch, world, tree, CONSTRAINT_FEEDBACK)
        solve(model, scratch, world, tree)
        measure_joint_wrenches(model, settings, state, scratch, world, tree, EXACT)


@func
def add_bullets_loads(
    model: Model, settings: Settings, state: State, scratch: Scratch, world: Int32, tree: Int32
):
    """Add what Bullet adds, from the force that each link needs."""
    generalized_forces(model, state, scratch, world, tree, CONSTRAINT_FEEDBACK)
    solve(model, scratch, world, tree)
    measure_joint_wrenches(model, settings, state, scratch, world, tree, BULLETS)
