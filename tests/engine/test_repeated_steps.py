"""A step that did not fit into its arrays is repeated from where it began: nobody can tell that it was."""

from __future__ import annotations

import numpy as np
import pytest
from tests.physics.contact_scenes import HALF, add_ball, add_box, add_floor, earth

from carom import World
from carom.layouts.flags import ActivationChange

BALLS, FALL = 40, 0.05


def scene(substeps: int) -> World:
    """Boxes at rest, which sleep soon and whose contacts remember a lot, and balls that land all at once."""
    world = earth(substeps=substeps)
    add_floor(world, friction_anchor=True)
    for place in range(3):
        box = add_box(world, (0.0, 0.0, HALF + 2.0 * HALF * place), friction_anchor=True)
        box.change_dynamics(-1, activation_state=int(ActivationChange.ENABLE_SLEEPING))
    slider = add_box(world, (2.0, 0.0, HALF), friction_anchor=True)
    slider.set_base_velocity((0.4, 0.1, 0.0), (0.0, 0.0, 0.0))
    return world


def drop_balls(world: World) -> None:
    """Balls in a row over the floor: more contacts than there is room for, within one step."""
    for place in range(BALLS):
        add_ball(world, (5.0 + 3.0 * HALF * place, 0.0, HALF + FALL))


def assert_same_state(ours: World, theirs: World) -> None:
    for table, other, rows in (
        (ours.arrays.state, theirs.arrays.state, ours.arrays.used),
        (
            ours.contact_arrays.contacts,
            theirs.contact_arrays.contacts,
            {"contact": ours.contact_arrays.contact_count, "overlap": ours.contact_arrays.overlap_count},
        ),
    ):
        for name, array in table.numpy.items():
            axis = name.partition("_")[0]
            if axis in rows:
                count = rows[axis]
                np.testing.assert_array_equal(array[0, :count], other.numpy[name][0, :count], err_msg=name)


@pytest.mark.parametrize("settling", [20, 450])
@pytest.mark.parametrize("substeps", [0, 3])
def test_a_world_without_room_is_the_same_as_a_roomy_one(substeps: int, settling: int) -> None:
    small = scene(substeps)
    small.step(settling)
    drop_balls(small)
    roomy = small.copy()
    roomy.contact_arrays.contacts.reserve({"contact": 1000, "overlap": 1000})
    roomy.engine.workspace.pairs.reserve({"pair": 1000})
    roomy.engine.workspace.pair_rows.reserve({"row": 5000, "jacobian": 10000, "matrix": 5000})
    roomy.scene_changed()
    growths = small.engine.growths
    for _ in range(40):
        small.step()
        roomy.step()
        assert_same_state(small, roomy)
    assert small.engine.growths > growths
    assert roomy.engine.growths == 0
