"""How many factorisations the converged laws take: what takes more of them takes more time."""

from __future__ import annotations

import numpy as np
import pytest
from tests.converged.rigid_worlds import rigid_world, tower
from tests.converged.yielding_scenes import SCENES

from carom import World


def _factorisations(world: World, steps: int) -> list[int]:
    """Those of each step, of all islands together."""
    counts: list[int] = []
    for _ in range(steps):
        world.step()
        counts.append(sum(int(island["numIterationsUsed"]) for island in world.analytics()))
    return counts


def test_a_tower_at_rest_takes_one_a_step() -> None:
    world = rigid_world()
    tower(world, 10)
    counts = _factorisations(world, 120)
    # In the first step all contacts are new.
    assert counts[0] <= 40
    assert set(counts[1:]) == {1}


def test_a_box_that_slides_takes_two_a_step() -> None:
    world = rigid_world(np.arctan(0.6))
    world.add_plane(friction=1.0)
    world.add_box((0.1, 0.1, 0.1), (0.0, 0.0, 0.1), friction=0.5)
    assert max(_factorisations(world, 120)) <= 2


@pytest.mark.parametrize(("kind", "most"), [("boxes", 12500), ("balls", 10500)])
def test_a_heap_that_falls_takes_few(kind: str, most: int) -> None:
    world = rigid_world()
    world.add_plane()
    for i in range(12):
        place = (0.07 * (i % 3), 0.05 * (i % 2), 0.15 + 0.25 * i)
        if kind == "boxes":
            world.add_box((0.1, 0.1, 0.1), place)
        else:
            world.add_sphere(0.1, place)
    assert sum(_factorisations(world, 480)) <= most


@pytest.mark.parametrize(
    ("scene", "most"),
    [
        ("spheres, elliptic, condim 3, impratio 1.0", 24),
        ("spheres, pyramidal, condim 3, impratio 1.0", 24),
        ("box, pyramidal, condim 3, impratio 1.0", 8),
        ("limb, pyramidal, condim 6, impratio 1.0", 20),
    ],
)
def test_contacts_that_yield_take_about_one_a_step(scene: str, most: int, tmp_path) -> None:
    file = tmp_path / "scene.xml"
    file.write_text(SCENES[scene])
    world = World(contact="compliant")
    world.load_mjcf(file)
    assert sum(_factorisations(world, 200)) <= most


_SERVOS = """<mujoco><worldbody><geom type="plane" size="1 1 1" pos="0 0 -1"/>
  <body name="arm"><joint name="a" axis="0 1 0" range="-90 90" damping=".1"/>
    <geom size=".05" fromto="0 0 0 .3 0 0" type="capsule"/>
    <body pos=".3 0 0"><joint name="b" axis="0 1 0" range="-90 90"/>
      <geom size=".04" fromto="0 0 0 .3 0 0" type="capsule"/></body></body></worldbody>
  <actuator><position joint="a" kp="80" kv="4"/><motor joint="b" ctrlrange="-1 1"/></actuator></mujoco>"""


def test_forces_that_are_given_take_none() -> None:
    world = World()
    arm = world.load(_SERVOS)["arm"]
    arm.actuators.controls = [0.3, 0.5]
    assert _factorisations(world, 30) == [0] * 30
    velocity = np.array(arm.joints.movable.velocities)
    # Newton's method finds the same motion where a limit is at work as well, of an arm on its own.
    other = World()
    twin = other.load(_SERVOS)["arm"]
    stopped = other.load(_SERVOS.replace("-90 90", "10 90").replace('"arm"', '"arm" pos="0 2 0"'))["arm"]
    twin.actuators.controls = [0.3, 0.5]
    assert max(_factorisations(other, 30)) >= 1
    assert stopped.joints.movable.positions[0] < np.deg2rad(10)
    np.testing.assert_array_equal(velocity, twin.joints.movable.velocities)


def test_an_arm_of_servos_that_meets_the_ground_takes_some() -> None:
    world = World()
    arm = world.load(_SERVOS)["arm"]
    arm.joints.movable.positions = [1.5, 0.2]
    counts = _factorisations(world, 400)
    assert counts[0] == 0
    assert max(counts) >= 1
