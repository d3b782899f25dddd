"""How threads share a list of worlds."""

from __future__ import annotations

import numpy as np
import pytest

from carom import World, Worlds
from carom.engine.interpreter import Interpreter


def falling(count: int, threads: int) -> tuple[Worlds, list[Interpreter]]:
    """Worlds with a ball each that falls, ready for a step, and what runs it on each thread."""
    world = World()
    world.gravity = (0.0, 0.0, -9.81)
    world.add_sphere(0.1, mass=1.0, position=(0.0, 0.0, 5.0))
    worlds = Worlds(world, count, threads=threads)
    worlds.step()
    return worlds, [one for one in worlds._engine._steppers if isinstance(one, Interpreter)]


def counters_of(worlds: Worlds) -> np.ndarray:
    """How many worlds of each share have been taken."""
    counters = worlds._engine._runner._counters
    assert counters is not None
    return counters


def heights(worlds: Worlds) -> np.ndarray:
    """Height of the ball in each world [m]."""
    return worlds._engine.arrays.state.numpy["position"][:, 2].copy()


@pytest.mark.parametrize("count", [3, 4, 7, 64, 130])
@pytest.mark.parametrize("first", [0, 1, 2])
def test_a_thread_that_is_alone_takes_the_worlds_of_all(count: int, first: int) -> None:
    worlds, interpreters = falling(count, 3)
    before = heights(worlds)
    counters_of(worlds)[:] = 0
    interpreters[first].run()
    after = heights(worlds)
    assert (after < before).all() and len(set(after.tolist())) == 1
    # Nothing is left for the others.
    for interpreter in interpreters:
        interpreter.run()
    np.testing.assert_array_equal(heights(worlds), after)


def test_each_thread_begins_with_its_own_share() -> None:
    worlds, interpreters = falling(120, 3)
    counters = counters_of(worlds)
    height = heights(worlds)[0]
    # Shares of other threads have been taken already, as far as this one can see.
    for thread, interpreter in enumerate(interpreters):
        counters[:] = 1000
        counters[thread] = 0
        interpreter.run()
        has_fallen = heights(worlds) < height
        assert has_fallen[: 40 * (thread + 1)].all() and not has_fallen[40 * (thread + 1) :].any()
