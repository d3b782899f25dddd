"""Launches learn of new settings, whatever interrupts the telling."""

from __future__ import annotations

import pytest

from carom import World
from carom.engine.parameters import EngineParameters
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


def test_gravity_changes_between_steps_without_preparing_them_again() -> None:
    worlds = [World(), World()]
    for world in worlds:
        world.add_sphere(0.1)
        world.gravity = (0.0, 0.0, -9.81)
        world.step()
    prepared = worlds[0]._derived.step
    assert prepared is not None
    for world in worlds:
        world.gravity = (1.0, 2.0, 3.0)
        if world is worlds[1]:
            world.scene_changed()
        world.step(2)
        assert world.gravity.tolist() == [1.0, 2.0, 3.0]
    assert worlds[0]._derived.step is prepared
    assert (worlds[0].velocity[:6] == worlds[1].velocity[:6]).all()
    assert worlds[0].velocity[3] == pytest.approx(2.0 / 240.0, rel=0.01)


@pytest.mark.parametrize("substeps", [1, 2, 3])
def test_substeps_are_those_that_fit_into_the_elapsed_time(substeps: int) -> None:
    parameters = EngineParameters(time_step=1 / 256, substeps=substeps)
    count, unspent = parameters.substeps_due(0.0)
    # Thirds are rounded: one may be left for the step after.
    assert count in ({substeps} if substeps < 3 else {2, 3})
    assert unspent == pytest.approx(1 / 256 - count * parameters.substep_time, abs=1e-15)
