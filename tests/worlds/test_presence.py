"""Bodies that are absent in some worlds: the others move as if they had never been made."""

from __future__ import annotations

from collections.abc import Collection
from pathlib import Path

import numpy as np
import pytest
from tests.physics.contact_scenes import HALF, add_ball, add_box, add_floor, earth
from tests.soft.scenes import world as empty_world
from tests.worlds.same_bits import assert_same_bits

import pybullet_data
from carom import Body, Camera, World, Worlds
from carom.layouts.codes import UserConstraintKind
from carom.layouts.contacts import THERE
from carom.layouts.flags import ActivationChange
from carom.render.lights import Light

DATA = pybullet_data.getDataPath()
GONE = (set(), {"panda"}, {"ball 1", "box 2", "ball 5"}, {"floor"}, {"stairs", "box 0"})
"""What is absent in each world."""


def add_stairs(world: World) -> Body:
    heights = np.tile(0.05 * np.arange(8.0), (8, 1))
    return world.add_heightfield(heights, (0.2, 0.2), (2.0, 0.0, 0.0))


def add_panda(world: World) -> Body:
    panda = world.load_urdf(f"{DATA}/franka_panda/panda.urdf", (0.0, -1.0, 0.0), fixed_base=True)
    panda.joints.set_velocity_targets(0.3, max_forces=20.0)
    return panda


def flying(without: Collection[str] = ()) -> tuple[World, dict[str, Body]]:
    """Two arms and two boxes that touch nothing."""
    world, bodies = earth(), {}
    if "panda" not in without:
        bodies["panda"] = add_panda(world)
    if "kuka" not in without:
        bodies["kuka"] = world.load_urdf(f"{DATA}/kuka_iiwa/model.urdf", (3.0, 0.0, 0.0), fixed_base=True)
        bodies["kuka"].joints.set_position_targets(0.7)
    for number in range(2):
        if f"box {number}" not in without:
            bodies[f"box {number}"] = box = add_box(world, (6.0 + number, 0.0, 50.0))
            box.set_base_velocity((1.0, number, 0.0), (0.1, 2.0, 0.3))
    return world, bodies


def piled(without: Collection[str] = ()) -> tuple[World, dict[str, Body]]:
    """An arm, stairs, and boxes and balls that fall onto a plane and each other; two boxes are tied."""
    world, bodies = earth(), {}
    if "floor" not in without:
        bodies["floor"] = world.load_urdf(f"{DATA}/plane.urdf")
    if "stairs" not in without:
        bodies["stairs"] = add_stairs(world)
    if "panda" not in without:
        bodies["panda"] = add_panda(world)
    for number in range(12):
        name = f"{'ball' if number in (1, 5, 7) else 'box'} {number}"
        if name not in without:
            add = add_ball if name.startswith("ball") else add_box
            place = (
                0.13 * (number % 4) + 1.1 * (number % 3),
                0.11 * (number // 4),
                0.15 + 0.21 * (number % 5),
            )
            bodies[name] = add(world, place)
    for one, other in (("box 0", "box 3"), ("box 2", "box 4")):
        if one in bodies and other in bodies:
            world.constrain_links(UserConstraintKind.POINT_TO_POINT, bodies[one], -1, bodies[other], -1)
    return world, bodies


def absent_worlds(
    scene: World, bodies: dict[str, Body], gone: Collection[Collection[str]], threads: int
) -> Worlds:
    worlds = Worlds(scene, len(gone), threads=threads)
    for name, body in bodies.items():
        worlds[body].present = [name not in absent for absent in gone]
    return worlds


def assert_same_motion(worlds: Worlds, number: int, bodies: dict[str, Body], lone: dict[str, Body]) -> None:
    """The bodies that a lone world has are in the same state, bit for bit, in one of many worlds."""
    state = worlds._engine.arrays.state.numpy
    for name, alone in lone.items():
        ours, theirs = bodies[name].rows, alone.rows
        for field in ("position", "dof_velocity", "link_pose", "dof_motor_impulse", "dof_limit_impulse"):
            axis = field.partition("_")[0]
            here = slice(ours.first[axis], ours.first[axis] + ours.count[axis])
            there = slice(theirs.first[axis], theirs.first[axis] + theirs.count[axis])
            expected = alone.world.arrays.state.numpy[field][0, there]
            np.testing.assert_array_equal(state[field][number, here], expected, err_msg=f"{field} of {name}")


def contact_count(worlds: Worlds) -> list[int]:
    return worlds._engine.contact_arrays.contacts.numpy["count_contacts"][:, THERE].tolist()


@pytest.mark.parametrize("threads", [1, 3])
def test_free_bodies_move_as_without_the_absent(threads: int) -> None:
    gone = (set(), {"panda"}, {"kuka", "box 0"}, {"box 1"})
    scene, bodies = flying()
    worlds = absent_worlds(scene, bodies, gone, threads)
    worlds.step(90)
    for number, absent in enumerate(gone):
        alone, lone = flying(absent)
        alone.step(90)
        assert_same_motion(worlds, number, bodies, lone)


@pytest.mark.parametrize("threads", [1, 3])
def test_contacts_and_constraints_are_those_without_the_absent(threads: int) -> None:
    scene, bodies = piled()
    worlds = absent_worlds(scene, bodies, GONE, threads)
    worlds.step(150)
    counts = contact_count(worlds)
    assert len(set(counts)) > 2
    for number, absent in enumerate(GONE):
        alone, lone = piled(absent)
        alone.step(150)
        assert counts[number] == alone.contact_arrays.contact_count
        assert_same_motion(worlds, number, bodies, lone)


def test_an_absent_body_keeps_its_state_until_it_comes_back() -> None:
    scene, bodies = piled()
    worlds = Worlds(scene, 2, threads=1)
    worlds.step(20)
    panda, box = worlds[bodies["panda"]], worlds[bodies["box 6"]]
    before = [
        panda.joints.positions[1].copy(),
        panda.joints.velocities[1].copy(),
        box.base_inertial_poses[1].copy(),
    ]
    for body in (panda, box):
        body.set_present(False, where=[1])
        assert body.present.tolist() == [True, False]
    box.links[-1].apply_force((1e3, 0.0, 0.0))
    worlds.step(30)
    after = [panda.joints.positions[1], panda.joints.velocities[1], box.base_inertial_poses[1]]
    for value, kept in zip(after, before, strict=True):
        np.testing.assert_array_equal(value, kept)
    panda.present = box.present = True
    box.set_base_inertial_poses((9.0, 0.0, 5.0), where=[1])
    velocity = box.base_velocities[1, 2]
    worlds.step()
    assert (panda.joints.positions[1] != before[0]).any()
    assert box.base_velocities[1, 2] == pytest.approx(velocity - 9.81 / 240)
    assert box.base_velocities[1, 0] == pytest.approx(0.0, abs=0.5)


def test_a_floor_that_goes_and_comes_back() -> None:
    world = earth()
    floor = world.load_urdf(f"{DATA}/plane.urdf")
    box = add_box(world, (0.0, 0.0, HALF))
    worlds = Worlds(world, 2, threads=1)
    worlds.step(20)
    assert contact_count(worlds) == [4, 4]
    worlds[floor].set_present(False, where=[0])
    assert contact_count(worlds) == [0, 4]
    worlds.step(10)
    height = worlds[box].base_inertial_poses[:, 2].copy()
    assert height[0] < HALF - 0.005
    assert height[1] == pytest.approx(HALF, abs=1e-3)
    worlds[floor].present = True
    worlds[box].set_base_inertial_poses((0.0, 0.0, HALF))
    worlds[box].set_base_velocities(np.zeros(6))
    worlds.step(60)
    assert contact_count(worlds) == [4, 4]
    np.testing.assert_allclose(worlds[box].base_inertial_poses[:, 2], HALF, atol=1e-3)


def test_terrains_are_swapped_at_a_reset() -> None:
    world = earth()
    terrains = [world.add_heightfield(np.full((5, 5), height), (1.0, 1.0)) for height in (0.0, 0.5, 1.0)]
    ball = add_ball(world, (0.1, 0.1, 1.5))
    worlds = Worlds(world, 3, threads=1)
    start = worlds.snapshot()
    for shift in range(3):
        worlds.restore(start)
        for number, terrain in enumerate(terrains):
            worlds[terrain].present = (np.arange(3) + shift) % 3 == number
        worlds.step(240)
        expected = 0.5 * ((np.arange(3) + shift) % 3) + HALF
        np.testing.assert_allclose(worlds[ball].base_inertial_poses[:, 2], expected, atol=0.02)


def test_what_rests_on_a_body_that_goes_wakes_up() -> None:
    world = earth()
    floor, box = add_floor(world), add_box(world, (0.0, 0.0, HALF))
    box.change_dynamics(-1, activation_state=ActivationChange.ENABLE_SLEEPING | ActivationChange.SLEEP)
    world.step(3)
    assert box.asleep
    floor.present = False
    assert not box.asleep
    world.step(20)
    assert world.position[box.first_position + 2] < 0.95 * HALF
    assert world.contact_arrays.contact_count == 0


def test_sleep_leaves_the_absent_alone() -> None:
    """Sleep is the only stage that changes the states of activity of others."""
    world = earth()
    add_floor(world)
    boxes = [add_box(world, (0.3 * number, 0.0, HALF)) for number in range(2)]
    for box in boxes:
        box.change_dynamics(-1, activation_state=ActivationChange.ENABLE_SLEEPING)
    boxes[1].present = False
    world.step(600)
    assert boxes[0].asleep
    assert not boxes[1].present


@pytest.fixture
def shown() -> tuple[World, Body, Body, Worlds]:
    world = earth()
    add_floor(world)
    ball, box = add_ball(world, (0.0, 0.0, HALF)), add_box(world, (0.0, 0.4, HALF))
    worlds = Worlds(world, 3, threads=2)
    worlds[ball].present = [True, False, True]
    worlds[box].present = [True, True, False]
    return world, ball, box, worlds


def test_rays_pass_through_the_absent(shown: tuple[World, Body, Body, Worlds]) -> None:
    _, ball, box, worlds = shown
    hits = worlds.rays([(0, 0, 2), (0, 0.4, 2)], [(0, 0, -0.5), (0, 0.4, -0.5)])
    assert (hits.bodies == [[ball.id, box.id], [0, box.id], [ball.id, 0]]).all()
    lone = worlds.extract(1)
    assert not lone.bodies[ball.id].present
    assert lone.queries().cast_ray((0, 0, 2), (0, 0, -0.5)).body == 0


@pytest.mark.parametrize("light", [Light(), Light(shadow=True), Light(distance=np.inf, shadow=True)])
def test_images_leave_out_the_absent(shown: tuple[World, Body, Body, Worlds], light: Light) -> None:
    _, ball, box, worlds = shown
    camera = Camera.with_field_of_view(64, 48, 60.0, light=light)
    camera = camera.look_at((2.0, 0.0, 0.9), (0.0, 0.2, 0.1))
    images = worlds.images(camera)
    for number, seen in enumerate(({ball.id, box.id}, {box.id}, {ball.id})):
        assert set(np.unique(images.body_ids[number]).tolist()) - {-1, 0} == seen
        alone = earth()
        add_floor(alone)
        if number != 1:
            add_ball(alone, (0.0, 0.0, HALF))
        if number != 2:
            add_box(alone, (0.0, 0.4, HALF))
        for expected in (camera.capture(alone), camera.capture(worlds.extract(number))):
            np.testing.assert_array_equal(images.colour[number], expected.colour)
            np.testing.assert_array_equal(images.depth[number], expected.depth)


def test_presence_is_part_of_states_checkpoints_and_copies() -> None:
    scene, bodies = piled()
    worlds = absent_worlds(scene, bodies, GONE, 2)
    worlds.step(60)
    saved, checkpoint = worlds.snapshot(), worlds.checkpoint()
    lone = [worlds.extract(number) for number in range(len(GONE))]
    assert [name for name, body in bodies.items() if not lone[4].bodies[body.id].present] == [
        "stairs",
        "box 0",
    ]
    copies = [world.copy() for world in lone]
    worlds.step(40)
    expected = worlds._engine.arrays.state.numpy["position"].copy()
    for number, (world, copied) in enumerate(zip(lone, copies, strict=True)):
        for single in (world, copied):
            single.step(40)
            assert_same_bits(worlds, number, single)
    for body in bodies.values():
        worlds[body].present = True
    worlds.restore(saved)
    assert worlds[bodies["panda"]].present.tolist() == [True, False, True, True, True]
    worlds.step(40)
    np.testing.assert_array_equal(worlds._engine.arrays.state.numpy["position"], expected)
    other = Worlds(piled()[0], len(GONE), threads=1)
    other.resume(checkpoint)
    other.step(40)
    np.testing.assert_array_equal(other._engine.arrays.state.numpy["position"], expected)


def test_presence_is_part_of_files_of_worlds(tmp_path: Path) -> None:
    world, bodies = piled()
    world.step(30)
    bodies["panda"].present = bodies["floor"].present = False
    world.save(tmp_path / "world.carom")
    loaded = World()
    loaded.load_saved(tmp_path / "world.carom")
    assert [body.present for body in loaded.bodies.values()] == [body.present for body in bodies.values()]
    for each in (world, loaded):
        each.step(30)
    np.testing.assert_array_equal(world.position, loaded.position)


def test_worlds_of_a_scene_with_absent_bodies() -> None:
    scene, bodies = flying()
    bodies["kuka"].present = False
    worlds = Worlds(scene, 2, threads=1)
    assert not worlds[bodies["kuka"]].present.any()
    worlds.step(30)
    alone, lone = flying({"kuka"})
    alone.step(30)
    assert_same_motion(worlds, 1, bodies, lone)


def test_what_cannot_be_absent_says_so() -> None:
    world = empty_world()
    rope = world.load_rope(1.0, 4)
    worlds = Worlds(world, 2)
    with pytest.raises(ValueError, match="a soft body is present in all worlds"):
        worlds[rope].present = False
    scene, bodies = flying()
    with pytest.raises(ValueError, match="present has shape"):
        Worlds(scene, 2)[bodies["kuka"]].set_present([True, False, True])


def test_worlds_on_a_gpu_refuse() -> None:
    pytest.importorskip("warp")
    scene, bodies = flying()
    with pytest.raises(ValueError, match="on a GPU yet"):
        Worlds(scene, 2, device="warp-cpu")[bodies["kuka"]].present = False
    bodies["kuka"].present = False
    with pytest.raises(ValueError, match="cannot simulate absent bodies yet"):
        Worlds(scene, 2, device="warp-cpu")


def test_coordinates_are_copied_with_who_is_present():
    world, bodies = piled()
    worlds = Worlds(world, 2)
    worlds[bodies["ball 1"]].set_present([True, False])
    worlds[bodies["floor"]].set_present([False, True])
    copy = world.copy()
    copy.step(5)
    for number in (0, 1, 0):
        worlds.copy_coordinates(number, copy)
        assert copy.bodies[bodies["ball 1"].id].present is (number == 0)
        assert copy.bodies[bodies["floor"].id].present is (number == 1)
