"""Gradients by changes of positions and by their coordinates are told from one another."""

import numpy as np
from numpy.testing import assert_allclose
from tests.algorithms.moving_robots import ROBOTS, load
from tests.linearization.scenes import excite, new_world

from carom.linearization.tangent import TangentSpace


def test_gradients_by_changes_are_found_again_from_those_by_coordinates():
    world = new_world()
    for number, name in enumerate(ROBOTS):
        excite(load(world, name), seed=number)
    space, rng = TangentSpace(world), np.random.default_rng(0)
    own = world.position[: len(world.position)]
    positions = np.stack([own, own])
    gradients = rng.normal(size=(2, len(space)))
    by_coordinates = space.of_coordinates(positions, gradients)
    assert_allclose(space.of_changes(positions, by_coordinates), gradients, rtol=0, atol=1e-12)
    # Each of a planar joint, a spherical one and a free base is among them.
    assert len(space.several) >= 3 + 3 + 6
