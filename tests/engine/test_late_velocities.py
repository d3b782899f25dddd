"""Late velocities of links, of bodies loaded with `URDF_GLOBAL_VELOCITIES_MB`, are a part of the state.

How they move such bodies is compared with PyBullet in `tests/conformance/scenarios/flags`.
"""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from tests.engine.failing import everything
from tests.linearization.test_sensors import add

import pybullet_data
from carom import Body, World, Worlds
from carom.description import Pose
from carom.errors import SimulationError, StateError
from carom.layouts.flags import LoadFlags
from carom.world_files.container import Blocks, packed, unpacked

DATA = Path(pybullet_data.getDataPath())
FLAG = int(LoadFlags.GLOBAL_VELOCITIES)
LATE = ("late_velocity", "late_joint")


def turning(path: str = "r2d2.urdf", *, flags: int = FLAG, floor: bool = True) -> tuple[World, Body]:
    """A world with a robot that turns while it falls on a floor."""
    world = World()
    world.gravity = (0.0, 0.0, -9.81)
    if floor:
        world.load_urdf(DATA / "plane.urdf")
    body = world.load_urdf(DATA / path, (0.0, 0.0, 0.6), flags=flags)
    world.velocity[body.first_velocity : body.first_velocity + 6] = (5.0, 2.0, 3.0, 0.1, 0.2, 0.3)
    return world, body


def late(world: World) -> np.ndarray:
    """All late velocities in use, (links, 12)."""
    return np.concatenate([world.snapshot().state[name] for name in LATE], axis=1)


def assert_same(world: World, other: World) -> None:
    expected = everything(other)
    for name, array in everything(world).items():
        assert_array_equal(array, expected[name], err_msg=name)


def test_only_links_of_bodies_with_the_flag_have_them() -> None:
    world, body = turning(flags=0)
    assert late(world).shape == (0, 12)
    other = world.load_urdf(DATA / "r2d2.urdf", (3.0, 0.0, 0.6), flags=FLAG)
    assert late(world).shape == (other.joint_count, 12)
    world.step()
    assert late(world).any()
    world.remove(other.id)
    assert late(world).shape == (0, 12)
    world.remove(body.id)


def test_a_body_beside_others_moves_as_alone_and_so_do_these() -> None:
    bare = LoadFlags.IGNORE_COLLISION_SHAPES
    scenes = [turning(flags=FLAG | bare, floor=False), turning(flags=bare, floor=False)]
    both, first = turning(flags=FLAG | bare, floor=False)
    second = both.load_urdf(DATA / "r2d2.urdf", (0.0, 0.0, 0.6), flags=bare)
    both.velocity[second.first_velocity : second.first_velocity + 6] = (5.0, 2.0, 3.0, 0.1, 0.2, 0.3)
    for world in (both, *(world for world, _ in scenes)):
        world.step(30)
    count = scenes[0][0].arrays.used["position"]
    found = [both.position[body.first_position :][:count] for body in (first, second)]
    for position, (world, _) in zip(found, scenes, strict=True):
        assert_array_equal(position, world.position[:count])
    assert np.abs(found[0] - found[1]).max() > 1e-5


@pytest.mark.parametrize("substeps", [0, 3])
def test_a_failed_step_leaves_them_as_they_were(substeps: int) -> None:
    (world, body), (spared, _) = turning(), turning()
    for scene in (world, spared):
        scene.parameters.substeps = substeps
        scene.step(5)
    before = late(world)
    world.link_force[body.first_link] = math.nan
    with pytest.raises(SimulationError):
        world.step()
    assert before.any()
    assert_array_equal(late(world), before)
    for scene in (world, spared):
        scene.step(20)
    assert_same(world, spared)


def test_states_and_files_have_them(tmp_path: Path) -> None:
    world, _ = turning()
    world.step(10)
    state = world.snapshot()
    world.save(tmp_path / "world")
    world.step(30)
    other = World()
    other.load(tmp_path / "world")
    other.step(30)
    assert_same(other, world)
    expected = everything(world)
    world.restore(state)
    world.step(30)
    for name, array in everything(world).items():
        assert_array_equal(array, expected[name], err_msg=name)


def test_files_from_before_are_loaded_without_them(tmp_path: Path) -> None:
    world, _ = turning()
    world.step(10)
    world.save(tmp_path / "new")
    document, rest = unpacked((tmp_path / "new").read_bytes(), tmp_path / "new")
    for name in LATE:
        del document["state"]["state"][name]
    for body in document["state"]["bodies"]:
        del body["late"]
    blocks = Blocks()
    blocks.add(bytes(rest))
    (tmp_path / "old").write_bytes(packed(document, blocks))
    other = World()
    other.load(tmp_path / "old")
    world.restore(tmp_path / "old")
    for scene in (world, other):
        assert not late(scene).any()
        scene.step(30)
    assert_same(other, world)


def test_a_state_finds_them_where_the_body_was_loaded_again() -> None:
    world, first = turning(floor=False)
    second = world.load_urdf(DATA / "cartpole.urdf", (3.0, 0.0, 0.6), flags=FLAG)
    world.step(3)
    state, before = world.snapshot(), late(world)
    joints = first.joint_count
    world.remove(first.id)
    again = world.load_urdf(DATA / "r2d2.urdf", flags=FLAG)
    assert again.id == first.id
    world.restore(state)
    assert second.joint_count > 0
    assert_array_equal(late(world), np.concatenate([before[joints:], before[:joints]]))


def test_a_state_of_a_body_without_the_flag_does_not_fit() -> None:
    world, body = turning(floor=False)
    state = world.snapshot()
    world.remove(body.id)
    world.load_urdf(DATA / "r2d2.urdf")
    with pytest.raises(StateError, match=r"it had .* and late velocities of \d+ links"):
        world.restore(state)


def test_many_worlds_move_as_each_alone() -> None:
    world, _ = turning()
    worlds = Worlds(world, 9, threads=2)
    world.step(40)
    worlds.step(40)
    for number in (0, 8):
        assert_same(worlds.extract(number), world)


@pytest.mark.parametrize("contact", ["bullet", "rigid"])
def test_every_law_of_contacts_takes_them(contact: str) -> None:
    moved = []
    for flags in (FLAG, 0):
        world, body = turning(flags=flags)
        world.parameters.contact = contact
        world.step(20)
        moved.append(world.position[body.first_position : body.first_position + 3].copy())
    assert 1e-5 < np.abs(moved[0] - moved[1]).max() < 0.1


def test_sensors_of_sites_measure_the_forces_that_move_the_links() -> None:
    loads = []
    for followed in (True, False):
        world, body = turning(floor=False)
        body.add_site("neck", 2, Pose())
        add(body, "Force", "load", site="neck")
        if not followed:
            world.arrays.model.numpy["tree_is_followed"][body.rows.tree] = 0
        world.step(10)
        loads.append(np.array(body.sensors["load"].read()))
    assert np.abs(loads[1]).max() > 0.1
    assert_allclose(loads[0], loads[1], rtol=1e-12)


def test_a_reset_to_a_keyframe_clears_them() -> None:
    world, body = turning(floor=False)
    body.add_keyframe("start")
    world.step(3)
    assert late(world).any()
    body.reset("start")
    assert not late(world).any()


def test_exact_derivatives_are_refused() -> None:
    world, _ = turning(floor=False)
    with pytest.raises(NotImplementedError, match=r"URDF_GLOBAL_VELOCITIES_MB .*differences"):
        world.linearize(method="exact")
    assert np.isfinite(world.linearize(method="differences").A).all()
