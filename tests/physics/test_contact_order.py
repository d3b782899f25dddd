"""The order in which manifolds are relaxed, against the quicksort that orders joint rows before the step."""

import numpy as np
import pytest
from tests.physics.contact_scenes import HALF, add_ball, add_floor, earth

from carom.description import Pose
from carom.layouts.codes import UserConstraintKind
from carom.model.solver_order import quicksort_order

BALLS = 40


@pytest.mark.parametrize("ties", [0, 10, 30, 60])
def test_manifolds_are_sorted_by_island_as_constraints_are(ties):
    """Each ball on the floor has one manifold; those that are tied together are one island."""
    world = earth()
    add_floor(world)
    balls = [add_ball(world, (3.0 * HALF * i, 0.0, HALF - 1e-4)) for i in range(BALLS)]
    roots = np.arange(BALLS)
    for a, b in np.random.default_rng(ties).integers(BALLS, size=(ties, 2)):
        if a != b:
            apart = Pose((3.0 * HALF * float(a - b), 0.0, 0.0))
            world.constrain_links(
                UserConstraintKind.POINT_TO_POINT, balls[a], -1, balls[b], -1, child_frame=apart
            )
            # As in Bullet the second root remains.
            roots[roots == roots[a]] = roots[b]
    world.step()
    # The floor has no number, since it cannot move.
    islands = roots.tolist()
    rows = world.engine.workspace.pair_rows.numpy
    order = quicksort_order(islands)
    assert rows["order_row"][0, :BALLS].tolist() == list(order)
    assert rows["order_island"][0, :BALLS].tolist() == [islands[manifold] for manifold in order]
