"""Motion of soft bodies within a substep, parallel over worlds.

The soft bodies of a world may push the same links and each other, one after the other as in a lone world.
"""

import warp as wp

from carom.kernels.parallel.workspace import is_called_off
from carom.kernels.soft.feedback import report_pushes
from carom.kernels.soft.stages import end_soft_motion, have_neighbours, take_small_steps
from carom.kernels.structs import Model, PairRows, Scratch, Settings, Shapes, SoftModel, SoftWork, State
from carom.kernels.types import kernel


@kernel
def small_steps_kernel(
    settings: Settings,
    model: Model,
    state: State,
    scratch: Scratch,
    shapes: Shapes,
    pair_rows: PairRows,
    soft: SoftModel,
    soft_work: SoftWork,
):
    """Move the soft bodies of each world."""
    world = wp.tid()
    if not is_called_off(state, world):
        take_small_steps(
            settings, model, shapes, scratch, pair_rows, soft, state, soft_work, world, have_neighbours(soft)
        )


@kernel
def soft_pushes_kernel(
    settings: Settings,
    model: Model,
    state: State,
    scratch: Scratch,
    shapes: Shapes,
    soft: SoftModel,
    soft_work: SoftWork,
):
    """Report the pushes of soft bodies, and give the trees of each world their velocities with them.

    Where rows did not fit nothing was pushed, and the end of the step puts the velocities back.
    """
    world = wp.tid()
    if not is_called_off(state, world):
        report_pushes(settings, shapes, model, state, scratch, soft, soft_work, world)
        end_soft_motion(settings, model, state, scratch, soft, soft_work, world)
