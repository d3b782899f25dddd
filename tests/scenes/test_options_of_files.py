"""Options of a file hold in a world that was empty; elsewhere a warning names those that differ."""

from __future__ import annotations

import logging
from pathlib import Path

import pytest

from carom import World

SCENE = """<mujoco><option timestep="0.004" gravity="0 0 -3.7" density="1.2"/><worldbody>
<body name="ball" pos="0 0 5"><freejoint/><geom size="0.1"/></body></worldbody></mujoco>"""


@pytest.fixture
def file(tmp_path: Path) -> Path:
    path = tmp_path / "scene.xml"
    path.write_text(SCENE)
    return path


def options(world: World) -> tuple[float, ...]:
    return world.time_step, *world.gravity, world.parameters.fluid_density


def test_an_empty_world_takes_them(file: Path, caplog: pytest.LogCaptureFixture):
    world = World()
    world.load(file)
    assert options(world) == (0.004, 0.0, 0.0, -3.7, 1.2)
    assert not caplog.records
    # They are those of the world already.
    world.load(file)
    assert not caplog.records


def test_what_nothing_states_is_as_in_mujoco(tmp_path: Path):
    (tmp_path / "plain.xml").write_text('<mujoco><worldbody><geom size="1"/></worldbody></mujoco>')
    world = World()
    world.load(tmp_path / "plain.xml")
    assert options(world) == (0.002, 0.0, 0.0, -9.81, 0.0)


def test_what_was_set_before_stays_and_is_named(file: Path, caplog: pytest.LogCaptureFixture):
    world = World(0.01, gravity=(0.0, 0.0, -9.81))
    scene = world.load(file)
    assert options(world) == (0.01, 0.0, 0.0, -9.81, 1.2)
    (record,) = caplog.records
    assert record.levelno == logging.WARNING
    said = record.getMessage()
    assert "gravity (0.0, 0.0, -3.7) (here (0.0, 0.0, -9.81))" in said
    assert "time_step 0.004 (here 0.01)" in said
    assert "fluid_density" not in said
    scene.apply_options()
    assert options(world) == (0.004, 0.0, 0.0, -3.7, 1.2)


@pytest.mark.parametrize("how", ["argument", "attribute"])
def test_what_was_set_to_the_default_stays_too(file: Path, how: str, caplog: pytest.LogCaptureFixture):
    world = World(1.0 / 240.0, gravity=(0.0, 0.0, 0.0)) if how == "argument" else World()
    if how == "attribute":
        world.time_step, world.gravity = 1.0 / 240.0, (0.0, 0.0, 0.0)
    for it in (world, world.copy()):
        it.load(file)
        assert options(it)[:4] == (1.0 / 240.0, 0.0, 0.0, 0.0)
        assert "time_step 0.004" in caplog.text
    world.clear()
    world.load(file)
    # A reset keeps the time step, and nothing else.
    assert options(world)[:4] == (1.0 / 240.0, 0.0, 0.0, -3.7)


def test_a_world_with_bodies_keeps_its_own(file: Path, caplog: pytest.LogCaptureFixture):
    world = World()
    world.add_plane()
    before = options(world)
    world.load(file)
    assert options(world) == before
    assert "scene.apply_options() sets them" in caplog.records[0].getMessage()
    other = World()
    other.load_mjcf(file)
    assert options(other) == before


def test_an_urdf_file_says_nothing_of_them(caplog: pytest.LogCaptureFixture):
    world = World()
    before = options(world)
    world.load("r2d2.urdf")
    assert options(world) == before
    assert "options" not in caplog.text
