"""What soft bodies may touch within a substep: shapes, links that hold them, and each other."""

import warp as wp

from carom.kernels.parallel.trees import note_first_fault
from carom.kernels.parallel.workspace import is_called_off
from carom.kernels.soft.face_touches import find_face_touches
from carom.kernels.soft.neighbours import find_neighbours
from carom.kernels.soft.stages import have_neighbours, start_soft_motion, write_rows
from carom.kernels.soft.touches import find_touches
from carom.kernels.structs import (
    IslandWork,
    Model,
    PairRows,
    Pairs,
    Scratch,
    Settings,
    Shapes,
    SoftModel,
    SoftWork,
    State,
)
from carom.kernels.types import kernel
from carom.layouts.soft import BODIES


@kernel
def soft_start_kernel(
    settings: Settings,
    model: Model,
    state: State,
    shapes: Shapes,
    pairs: Pairs,
    soft_work: SoftWork,
    work: IslandWork,
):
    """Start the motion of the soft bodies of each world, unless the free motion of a tree was at fault."""
    world = wp.tid()
    note_first_fault(settings, state, work.tree_free_fault, world)
    if not is_called_off(state, world):
        start_soft_motion(settings, model, state, shapes, pairs, soft_work, world)


@kernel
def soft_touches_kernel(
    settings: Settings,
    model: Model,
    state: State,
    scratch: Scratch,
    shapes: Shapes,
    pairs: Pairs,
    soft: SoftModel,
    soft_work: SoftWork,
):
    """Find the shapes near the nodes of each body."""
    body, world = wp.tid()
    if not is_called_off(state, world):
        find_touches(settings, shapes, model, state, scratch, pairs, soft, soft_work, world, body)


@kernel
def soft_rows_kernel(
    settings: Settings,
    model: Model,
    state: State,
    scratch: Scratch,
    shapes: Shapes,
    pairs: Pairs,
    pair_rows: PairRows,
    soft: SoftModel,
    soft_work: SoftWork,
):
    """Find the shapes near the faces of each world, and write the rows of all touches and anchors.

    They are written from the start of the arrays: the solver has not written its own yet. One thread handles
    all bodies of a world, because they share the workspace for overlaps of faces.
    """
    world = wp.tid()
    if not is_called_off(state, world):
        for body in range(soft.count_soft[BODIES]):
            find_face_touches(settings, shapes, model, state, scratch, pairs, soft, soft_work, world, body)
        write_rows(settings, model, state, scratch, shapes, pair_rows, soft, soft_work, world)


@kernel
def soft_neighbours_kernel(
    settings: Settings, model: Model, state: State, shapes: Shapes, soft: SoftModel, soft_work: SoftWork
):
    """Find the faces of soft bodies near the nodes of each world."""
    world = wp.tid()
    if not is_called_off(state, world) and have_neighbours(soft):
        find_neighbours(settings, shapes, model, state, soft, soft_work, world)
