"""Free motion by other integrators of worlds that take their steps several at once."""

import warp as wp

from carom.kernels.dynamics.step import continue_free_motion, is_continued
from carom.kernels.integrators.midpoint import midpoint_motion
from carom.kernels.integrators.stages import explicit_motion
from carom.kernels.solver.islands import may_be_pushed
from carom.kernels.structs import Model, PairRows, Scratch, Settings, StageWork, State
from carom.kernels.types import Int32, kernel


@kernel
def continued_explicit_kernel(
    settings: Settings, model: Model, state: State, scratch: Scratch, pair_rows: PairRows, first_world: Int32
):
    """As `explicit_motion_kernel`, after `lane_motion_kernel` with a time step of 0."""
    world = first_world + wp.tid()
    for tree in range(settings.tree_count):
        if is_continued(model, tree):
            continue_free_motion(model, settings, state, scratch, world, tree)
        else:
            explicit_motion(
                model, settings, state, scratch, world, tree, may_be_pushed(model, pair_rows, world, tree)
            )


@kernel
def continued_midpoint_kernel(
    settings: Settings,
    model: Model,
    state: State,
    scratch: Scratch,
    pair_rows: PairRows,
    stage_work: StageWork,
    first_world: Int32,
):
    """As `midpoint_motion_kernel`, after `lane_motion_kernel`."""
    world = first_world + wp.tid()
    for tree in range(settings.tree_count):
        if is_continued(model, tree):
            continue_free_motion(model, settings, state, scratch, world, tree)
        else:
            midpoint_motion(
                model, settings, state, scratch, stage_work, world, tree,
                may_be_pushed(model, pair_rows, world, tree),
            )  # fmt: skip
