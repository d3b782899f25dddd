"""The law and the integrator of a world of which nobody has said another one."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from tests.converged.rigid_worlds import GRAVITY, centres, tower

import pybullet as p
from carom import World, Worlds

_BALL = "<body name='ball' pos='0 0 1'><freejoint/><geom size='.1'/></body>"


def _file(folder: Path, option: str = "") -> Path:
    path = folder / "ball.xml"
    path.write_text(f"<mujoco>{option}<worldbody>{_BALL}</worldbody></mujoco>")
    return path


def test_a_tower_off_centre_stands_in_a_world_as_it_is_made() -> None:
    world = World(gravity=(0.0, 0.0, -GRAVITY))
    boxes = tower(world, 10)
    world.step(240)
    start = centres(boxes)
    world.step(240 * 9)
    assert np.linalg.norm(centres(boxes) - start, axis=1).max() < 1e-4


def test_the_integrator_follows_the_law_until_somebody_sets_it() -> None:
    world = World()
    assert (world.contact, world.integrator) == ("compliant", "midpoint")
    assert World(contact="bullet").integrator == "discrete"
    world.contact = "bullet"
    assert world.integrator == "discrete"
    world.contact = "rigid"
    assert world.integrator == "midpoint"
    world.integrator = "discrete"
    world.contact = "bullet"
    world.contact = "compliant"
    assert world.integrator == "discrete"
    assert World(contact="bullet", integrator="midpoint").integrator == "midpoint"


def test_a_law_that_does_not_suit_an_integrator_changes_nothing() -> None:
    world = World(integrator="rk4")
    with pytest.raises(ValueError, match="needs contacts with forces at an instant"):
        world.contact = "rigid"
    assert (world.contact, world.integrator) == ("compliant", "rk4")


@pytest.mark.parametrize(
    ("option", "integrator"),
    [
        ("", "euler"),
        ("<option integrator='Euler'/>", "euler"),
        ("<option integrator='implicitfast'/>", "implicitfast"),
        ("<option timestep='0.01'/>", "euler"),
    ],
)
def test_an_mjcf_file_brings_its_integrator(tmp_path: Path, option: str, integrator: str) -> None:
    path = _file(tmp_path, option)
    world = World()
    world.load(path)
    assert world.integrator == integrator
    kept = World(integrator="midpoint")
    kept.load(path)
    assert kept.integrator == "midpoint"
    swept = World(contact="bullet")
    swept.load(path)
    assert swept.integrator == (integrator if "integrator" in option else "discrete")


def test_the_integrator_that_a_file_did_not_name_gives_way(tmp_path: Path) -> None:
    world = World()
    world.load(_file(tmp_path))
    world.contact = "rigid"
    assert world.integrator == "midpoint"
    cloth = World()
    cloth.load(_file(tmp_path))
    cloth.load_cloth((0.5, 0.5), (4, 4), (0.0, 0.0, 2.0))
    cloth.step(5)
    assert cloth.integrator == "euler"


def test_a_second_file_leaves_the_integrator_alone(tmp_path: Path) -> None:
    world = World()
    world.add_plane()
    world.load(_file(tmp_path))
    assert world.integrator == "midpoint"


def test_copies_files_and_many_worlds_have_the_law_too(tmp_path: Path) -> None:
    for law in ("bullet", "rigid", "compliant"):
        world = World(gravity=(0.0, 0.0, -GRAVITY), contact=law)
        tower(world, 2)
        world.step(20)
        world.save(tmp_path / "scene.carom")
        other = World()
        other.load_saved(tmp_path / "scene.carom")
        copy, worlds = world.copy(), Worlds(world, 2)
        for _ in range(10):
            for it in (world, other, copy, worlds):
                it.step()
        assert (other.contact, copy.contact, worlds.contact) == (law, law, law)
        assert (other.integrator, copy.integrator) == (world.integrator, world.integrator)
        assert other.position.tolist() == copy.position.tolist() == world.position.tolist()
        assert worlds["box1"].pose.position[1].tolist() == world["box1"].pose.position.tolist()


def test_the_drop_in_has_the_sweeps_of_pybullet() -> None:
    client = p.connect(p.DIRECT)
    try:
        p.setGravity(0, 0, -10, physicsClientId=client)
        shape = p.createCollisionShape(p.GEOM_BOX, halfExtents=[0.1] * 3, physicsClientId=client)
        floor = p.createCollisionShape(p.GEOM_PLANE, physicsClientId=client)
        p.createMultiBody(0, floor, physicsClientId=client)
        box = p.createMultiBody(1, shape, basePosition=[0, 0, 0.2], physicsClientId=client)
        for _ in range(100):
            p.stepSimulation(physicsClientId=client)
        height = p.getBasePositionAndOrientation(box, physicsClientId=client)[0][2]
    finally:
        p.disconnect(client)
    world = World(gravity=(0.0, 0.0, -10.0), contact="bullet")
    world.add_plane()
    ours = world.add_box((0.1, 0.1, 0.1), (0.0, 0.0, 0.2), mass=1.0)
    world.step(100)
    assert height == pytest.approx(ours.pose.position[2], abs=1e-6)
