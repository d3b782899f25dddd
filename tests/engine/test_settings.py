"""Launches learn of new settings, whatever interrupts the telling."""

from __future__ import annotations

import pytest

from carom import World
from carom.engine.settings import EngineSettings


def _interrupt() -> None:
    raise KeyboardInterrupt


@pytest.mark.parametrize("iterations", [7, 9])
def test_launches_are_told_after_an_interrupt_also_if_settings_are_what_they_were(iterations: int) -> None:
    world, settings, told = World(), EngineSettings(), []

    def update() -> None:
        settings.update(
            world.parameters,
            world.arrays,
            world.contact_arrays,
            lambda: told.append(settings.struct.iterations),
        )

    world.parameters.solver_iterations = 7
    update()
    update()
    assert told == [7]
    world.parameters.solver_iterations = 9
    with pytest.raises(KeyboardInterrupt):
        settings.update(world.parameters, world.arrays, world.contact_arrays, _interrupt)
    world.parameters.solver_iterations = iterations
    update()
    update()
    assert told == [7, iterations]
