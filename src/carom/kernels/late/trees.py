"""Motion of a tree whose links may have late velocities, in place of that of `kernels.dynamics.step`."""

from carom.kernels.dynamics.feedback import add_bullets_loads, add_exact_loads
from carom.kernels.dynamics.kinematics import has_late_links
from carom.kernels.dynamics.lane_motion import accelerate_by_forces, place_links
from carom.kernels.dynamics.motors import explicit_pd
from carom.kernels.dynamics.step import free_motion, move_or_stop, take_accelerations, take_impulses
from carom.kernels.late.velocities import keep_late_velocities, late_bias_forces
from carom.kernels.solver.activity import has_woken, is_left_out, stop
from carom.kernels.solver.joint_solver import clear_delta_velocities
from carom.kernels.structs import Model, Scratch, Settings, State
from carom.kernels.types import Int32, func
from carom.layouts.codes import CONSTRAINT_FEEDBACK, FREE_MOTION


@func
def late_free_motion(
    model: Model, settings: Settings, state: State, scratch: Scratch, world: Int32, tree: Int32, pushed: bool
):
    """As `free_motion`, for a tree that is awake and whose links have late velocities."""
    explicit_pd(model, state, world, tree)
    place_links(model, state, scratch, world, tree)
    late_bias_forces(model, state, scratch, world, tree, FREE_MOTION)
    accelerate_by_forces(model, settings.time_step, state, scratch, world, tree)
    take_accelerations(model, settings, state, scratch, world, tree, pushed)
    keep_late_velocities(model, state, scratch, world, tree)
    if has_woken(state, world, tree):
        stop(model, state, world, tree)
    clear_delta_velocities(model, scratch, world, tree)


@func
def any_free_motion(
    model: Model, settings: Settings, state: State, scratch: Scratch, world: Int32, tree: Int32, pushed: bool
):
    """As `free_motion`, for any tree."""
    if has_late_links(model, tree) and not is_left_out(state, world, tree):
        late_free_motion(model, settings, state, scratch, world, tree, pushed)
    else:
        free_motion(model, settings, state, scratch, world, tree, pushed)


@func
def late_feedback(
    model: Model, settings: Settings, state: State, scratch: Scratch, world: Int32, tree: Int32
):
    """As `constraint_feedback`; as in Bullet it keeps velocities of links as well."""
    add_exact_loads(model, settings, state, scratch, world, tree)
    late_bias_forces(model, state, scratch, world, tree, CONSTRAINT_FEEDBACK)
    add_bullets_loads(model, settings, state, scratch, world, tree)
    keep_late_velocities(model, state, scratch, world, tree)


@func
def move_or_stop_any(
    settings: Settings, model: Model, state: State, scratch: Scratch, world: Int32, tree: Int32
):
    """As `move_or_stop`, for any tree."""
    is_felt = has_late_links(model, tree) and model.tree[tree].sensed_count > 0
    if is_felt and not is_left_out(state, world, tree):
        late_feedback(model, settings, state, scratch, world, tree)
        take_impulses(settings, model, state, scratch, world, tree)
    else:
        move_or_stop(settings, model, state, scratch, world, tree)
