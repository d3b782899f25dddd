"""Free rotation by the implicit midpoint rule, for bodies of one link whose moments of inertia differ.

In the axes of the body, with ω after all torques of the substep, I (ω' − ω) = −h ω̄ × I ω̄, ω̄ = (ω + ω') / 2
(J. C. Simo, K. K. Wong, Unconditionally stable algorithms for rigid body dynamics that exactly preserve
energy and momentum, 1991). The body turns by h ω̄, which is what rows see, and its angular momentum, with all
impulses, gives the angular velocity at the end. Everything else is as with the usual integrator.
"""

import warp as wp

from carom.kernels.dynamics.actuators import advance_activations
from carom.kernels.dynamics.dynamics import turned_inertia
from carom.kernels.dynamics.feedback import constraint_feedback
from carom.kernels.dynamics.integration import integrate_positions
from carom.kernels.dynamics.kinematics import base_omega
from carom.kernels.dynamics.single_body import is_single_body
from carom.kernels.dynamics.step import free_motion, move_or_stop
from carom.kernels.integrators.stages import base_turn, write_base_omega
from carom.kernels.joints.coordinates import three_numbers
from carom.kernels.maths.min_max import within_bounds
from carom.kernels.maths.rotation import rotation_matrix
from carom.kernels.maths.shares import TREES_PER_SHARE, next_share
from carom.kernels.solver.activity import has_woken, is_left_out
from carom.kernels.solver.islands import may_be_pushed
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
from carom.kernels.types import Int32, IntRows, Matrix3, Vector3, func, kernel, real

_ROUNDS = Int32(8)


@func
def wobbles(model: Model, state: State, world: Int32, tree: Int32) -> bool:
    """Whether a tree is one free body, awake, whose angular velocity changes without a torque."""
    if not is_single_body(model, tree) or is_left_out(state, world, tree) or has_woken(state, world, tree):
        return False
    moments = model.link_inertia[world, model.tree[tree].first_link]
    if wp.min(moments) <= 0.0:
        return False
    return moments[0] != moments[1] or moments[1] != moments[2]


@func
def skew(v: Vector3) -> Matrix3:
    """The matrix of the cross product v ×."""
    return Matrix3(0.0, -v[2], v[1], v[2], 0.0, -v[0], -v[1], v[0], 0.0)


@func
def mean_omega(moments: Vector3, omega: Vector3, h: real) -> Vector3:
    """The angular velocity ω̄ of a free body over a time h, in its axes, by Newton's method."""
    inertia = wp.diag(moments)
    mean = omega + Vector3(0.0, 0.0, 0.0)
    for _round in range(_ROUNDS):
        spin = wp.cw_mul(moments, mean)
        residual = 2.0 * wp.cw_mul(moments, mean - omega) + h * wp.cross(mean, spin)
        slope = 2.0 * inertia + h * (skew(mean) * inertia - skew(spin))
        mean -= wp.inverse(slope) * residual
    return mean


@func
def midpoint_motion(
    model: Model,
    settings: Settings,
    state: State,
    scratch: Scratch,
    work: StageWork,
    world: Int32,
    tree: Int32,
    pushed: bool,
):
    """As `step.free_motion`; keeps the momentum of a body that wobbles."""
    before = base_omega(model, state, world, tree)
    turning = wobbles(model, state, world, tree)
    free_motion(model, settings, state, scratch, world, tree, pushed)
    if turning:
        h = settings.time_step
        link = model.tree[tree].first_link
        moments = model.link_inertia[world, link]
        rotation = rotation_matrix(wp.transform_get_rotation(state.link_pose[world, link]))
        turned = wp.transpose(rotation)
        old = turned * before
        # What the torques of the substep give, without that of the rotation itself.
        kicked = turned * base_omega(model, state, world, tree) + h * wp.cw_div(
            wp.cross(old, wp.cw_mul(moments, old)), moments
        )
        momentum = rotation * wp.cw_mul(moments, kicked)
        first = model.tree[tree].first_velocity
        for axis in range(3):
            work.dof_first[world, first + axis] = momentum[axis]
        write_base_omega(model, state, world, tree, rotation * mean_omega(moments, kicked, h))


@kernel
def midpoint_motion_kernel(
    settings: Settings,
    model: Model,
    state: State,
    scratch: Scratch,
    pair_rows: PairRows,
    stage_work: StageWork,
    taken: IntRows,
    first_world: Int32,
):
    """Update velocities for a substep without constraints; keep momentum of bodies that wobble."""
    world = first_world + wp.tid()
    share = next_share(taken, Int32(-1))
    while TREES_PER_SHARE * share < settings.tree_count:
        first = TREES_PER_SHARE * share
        for tree in range(first, wp.min(first + TREES_PER_SHARE, settings.tree_count)):
            pushed = may_be_pushed(model, pair_rows, world, tree)
            midpoint_motion(model, settings, state, scratch, stage_work, world, tree, pushed)
        share = next_share(taken, share)


@func
def turn_body(
    model: Model,
    settings: Settings,
    state: State,
    scratch: Scratch,
    work: StageWork,
    world: Int32,
    tree: Int32,
):
    """As `step.move_or_stop`, for a body that wobbles."""
    if model.tree[tree].sensed_count > 0:
        constraint_feedback(model, settings, state, scratch, world, tree)
    link = model.tree[tree].first_link
    moments = model.link_inertia[world, link]
    rotation = rotation_matrix(wp.transform_get_rotation(state.link_pose[world, link]))
    free = base_omega(model, state, world, tree)
    apply_delta_velocities(model, state, scratch, world, tree)
    pushed = base_omega(model, state, world, tree) - free
    momentum = three_numbers(work.dof_first, world, model.tree[tree].first_velocity)
    momentum += turned_inertia(rotation, moments) * pushed
    if model.tree[tree].actuator_count > 0:
        advance_activations(model, settings, state, world, tree)
    integrate_positions(model, state, world, tree, settings.time_step)
    after = rotation_matrix(base_turn(model, state, world, tree))
    omega = after * wp.cw_div(wp.transpose(after) * momentum, moments)
    bound = model.tree_max_velocity[world, tree]
    for axis in range(3):
        omega[axis] = within_bounds(omega[axis], -bound, bound)
    write_base_omega(model, state, world, tree, omega)


@kernel
def midpoint_integration_kernel(
    settings: Settings,
    model: Model,
    state: State,
    scratch: Scratch,
    shapes: Shapes,
    contacts: Contacts,
    users: UserConstraints,
    stage_work: StageWork,
    taken: IntRows,
    first_world: Int32,
):
    """Add delta velocities to the velocities, and integrate positions."""
    world = first_world + wp.tid()
    share = next_share(taken, Int32(-1))
    while TREES_PER_SHARE * share < settings.tree_count:
        first = TREES_PER_SHARE * share
        for tree in range(first, wp.min(first + TREES_PER_SHARE, settings.tree_count)):
            gather_link_forces(settings, model, state, scratch, shapes, contacts, users, world, tree)
            if wobbles(model, state, world, tree):
                turn_body(model, settings, state, scratch, stage_work, world, tree)
            else:
                move_or_stop(settings, model, state, scratch, world, tree)
        share = next_share(taken, share)
