"""Checks of what bodies of a world can do, to skip unnecessary parts of its steps."""

from __future__ import annotations

import numpy as np

from carom.description.collision_groups import FIXED_GROUP, FIXED_MASK
from carom.engine.contact_arrays import ContactArrays
from carom.layouts.codes import ABSENT, ACTIVE
from carom.model.builder import WorldArrays


def can_collide(arrays: WorldArrays, contact_arrays: ContactArrays) -> bool:
    """Whether two shapes could ever touch: in one body, or in two bodies that are not both scenery.

    Scenery is bodies that have shapes only on their fixed base, with the filter group of fixed bases.
    """
    shapes, model = contact_arrays.shapes.table.numpy, arrays.model.numpy
    solid = np.flatnonzero(shapes["link_shape_count"][: arrays.used["link"]])
    if shapes["link_self_collision"][solid].any():
        return True
    first_links = model["tree_first_link"][: arrays.used["tree"]]
    trees = np.searchsorted(first_links, solid, side="right") - 1
    if (trees[1:] == trees[:-1]).all():
        return False
    if contact_arrays.shapes.filters.all:
        return True
    is_fixed_base = (model["tree_fixed"][trees] != 0) & (first_links[trees] == solid)
    groups, masks = shapes["link_group"][solid], shapes["link_mask"][solid]
    return not (is_fixed_base & (groups == FIXED_GROUP) & (masks == FIXED_MASK)).all()


def can_sleep(arrays: WorldArrays) -> bool:
    """Whether a body may fall asleep, has to be woken up, or was told to sleep and has to forget it."""
    count = arrays.used["tree"]
    # Of small arrays this takes less time than `any`.
    if np.count_nonzero(arrays.model.numpy["tree_can_sleep"][:count]):
        return True
    state = arrays.state.numpy
    if np.count_nonzero(np.asarray(state["tree_wants_sleep"])[:, :count]):
        return True
    activity = np.asarray(state["tree_activity"])[:, :count]
    others = activity != ACTIVE
    return bool(np.count_nonzero(others)) and bool((activity[others] != ABSENT).any())


def has_adhesion(arrays: WorldArrays) -> bool:
    """Whether some actuator pulls a link towards what touches it, see `kernels.adhesion`."""
    return bool(np.count_nonzero(arrays.model.numpy["actuator_pulled"][: arrays.used["actuator"]]))


def has_late_links(arrays: WorldArrays) -> bool:
    """Whether the velocities of some body's links are late, see `kernels.late`."""
    return bool(np.count_nonzero(arrays.model.numpy["tree_late_count"][: arrays.used["tree"]]))
