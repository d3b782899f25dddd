"""Worlds whose free motion is computed several at a time are bit for bit those that they would be alone."""

from __future__ import annotations

import numpy as np
import pytest
from tests.physics.contact_scenes import add_box, add_floor, earth
from tests.worlds.same_bits import (
    assert_all_same_bits,
    assert_as_stirred,
    assert_same_bits,
    stirred,
    stirred_worlds,
)
from tests.worlds.test_presence import DATA, GONE, absent_worlds, assert_same_motion, piled

from carom import Body, World, Worlds
from carom.engine.interpreter import Interpreter
from carom.engine.lane_work import LaneWork
from carom.layouts.flags import ActivationChange
from carom.layouts.programs import LANES


def robots() -> tuple[World, list[Body]]:
    """Robots with a fixed and with free bases, with ball joints and sliding ones, and what they touch."""
    world = earth()
    add_floor(world)
    bodies = [
        world.load_urdf(f"{DATA}/franka_panda/panda.urdf", (0.0, -1.0, 0.0), fixed_base=True),
        world.load_urdf(f"{DATA}/r2d2.urdf", (0.0, 1.0, 0.5)),
        world.load_urdf(f"{DATA}/humanoid/humanoid.urdf", (2.0, 0.0, 3.0), scale=0.25),
    ]
    bodies[0].joints.set_velocity_targets(0.3, max_forces=20.0)
    add_box(world, (0.0, 1.0, 2.0))
    return world, bodies


def works_of(worlds: Worlds) -> list[LaneWork | None]:
    return [one.lane_work for one in worlds._engine._steppers if isinstance(one, Interpreter)]


@pytest.mark.parametrize("threads", [1, 2])
@pytest.mark.parametrize("count", [1, 3, 4, 5, 9])
def test_any_number_of_worlds(count: int, threads: int) -> None:
    scene, _ = robots()
    worlds = stirred_worlds(scene, count, threads)
    for steps in (1, 25, 14):
        worlds.step(steps)
    assert (worlds._engine.steps_in_lanes > 0) == (count >= LANES)
    assert_as_stirred(worlds, scene, 40)


def test_each_lane_has_the_motion_of_its_world() -> None:
    scene, _ = robots()
    worlds = stirred_worlds(scene, LANES, threads=1)
    # In the first steps arrays of contacts may still grow.
    worlds.step(5)
    worlds.step()
    (work,) = works_of(worlds)
    assert work is not None
    poses = work.poses()
    assert poses.shape[-1] == LANES
    first, count = (scene.arrays.model.numpy[f"tree_{name}"][1] for name in ("first_link", "link_count"))
    expected = worlds._engine.arrays.state.numpy["link_pose"]
    for lane in range(LANES):
        rows = slice(first, first + count)
        np.testing.assert_array_equal(poses[rows, :, lane], expected[lane, rows])


def test_some_of_the_worlds() -> None:
    scene, _ = robots()
    worlds = stirred_worlds(scene, 9, threads=1)
    steps = np.zeros(9, dtype=int)
    for chosen, together in (([0, 1, 2, 3], 1), ([1, 3, 5, 7], 0), ([2, 3, 4, 5, 6, 7], 1), ([8], 0)):
        worlds.step(6, where=chosen)
        begun = worlds._engine.steps_in_lanes
        # Arrays of contacts grow in the first steps only.
        worlds.step(where=chosen)
        assert worlds._engine.steps_in_lanes - begun == together
        steps[chosen] += 7
    for number in range(9):
        lone = stirred(scene, number)
        lone.step(int(steps[number]))
        assert_same_bits(worlds, number, lone)


def test_absent_bodies() -> None:
    gone = (*GONE, *GONE[1:])
    scene, bodies = piled()
    worlds = absent_worlds(scene, bodies, gone, 1)
    # After a step in which arrays of contacts grow, a call continues one world at a time.
    for _ in range(6):
        worlds.step(10)
    assert worlds._engine.steps_in_lanes > 0
    for number, absent in enumerate(gone):
        alone, lone = piled(absent)
        alone.step(60)
        assert_same_motion(worlds, number, bodies, lone)


def test_robots_that_fall_asleep_in_some_worlds() -> None:
    scene = earth()
    add_floor(scene)
    robot = scene.load_urdf(f"{DATA}/r2d2.urdf", (0.0, 0.0, 0.5))
    robot.change_dynamics(-1, activation_state=int(ActivationChange.ENABLE_SLEEPING))
    worlds = stirred_worlds(scene, 5, threads=1)
    lone = [stirred(scene, number) for number in range(5)]
    pushed = [1, 4]
    worlds[robot].set_base_velocities(np.array([3.0, 0.0, 0.0, 0.0, 0.0, 0.0]), where=pushed)
    for number in pushed:
        lone[number].bodies[robot.id].set_base_velocity((3.0, 0.0, 0.0), (0.0, 0.0, 0.0))
    for _ in range(6):
        worlds.step(100)
        assert worlds._engine.steps_in_lanes > 0
        assert_all_same_bits(worlds, lone, 100)
    asleep = [world.bodies[robot.id].asleep for world in lone]
    assert any(asleep)


def test_sensors_and_terms_of_joints() -> None:
    scene, (arm, *_) = robots()
    arm.joints["panda_joint4"].enable_sensor()
    scene.bodies[arm.id].joints["panda_joint2"].armature = 0.1
    worlds = stirred_worlds(scene, 5, threads=1)
    for _ in range(4):
        worlds.step(5)
    assert worlds._engine.steps_in_lanes > 0
    assert_as_stirred(worlds, scene, 20)


def test_worlds_that_differ_in_whether_joints_have_terms() -> None:
    scene, (arm, *_) = robots()
    worlds = stirred_worlds(scene, 5, threads=1)
    dof = int(scene.arrays.model.numpy["tree_first_dof"][arm.rows.tree]) + 1
    armature = np.array([0.0, 0.2, 0.0, 0.1, 0.0])
    engine = worlds._engine
    for field, row, values in (
        ("dof_armature", dof, armature),
        ("tree_joint_terms", arm.rows.tree, armature > 0.0),
    ):
        engine.set_parameter("model", field, row, values.astype(float))
    worlds.step(5)
    worlds.step(15)
    assert engine.steps_in_lanes == 0
    for number in range(5):
        lone = stirred(scene, number)
        model = lone.arrays.model.numpy
        model["dof_armature"][0, dof] = armature[number]
        model["tree_joint_terms"][0, arm.rows.tree] = armature[number] > 0.0
        lone.step(20)
        assert_same_bits(worlds, number, lone)


def test_a_world_that_fails_leaves_the_others_alone() -> None:
    scene, (arm, *_) = robots()
    worlds = stirred_worlds(scene, 4, threads=1)
    worlds.step(5)
    dof = int(scene.arrays.model.numpy["tree_first_dof"][arm.rows.tree])
    worlds._engine.arrays.state.numpy["dof_velocity"][2, dof] = np.nan
    with pytest.warns(match="2"):
        worlds.step(10)
    assert worlds._engine.steps_in_lanes > 0
    assert_as_stirred(worlds, scene, 15, numbers=(0, 1, 3))


@pytest.mark.parametrize("touching", [False, True])
def test_lanes_have_memory_for_contacts_if_there_can_be_some(touching: bool) -> None:
    if touching:
        scene, _ = robots()
    else:
        scene = earth()
        arm = scene.load_urdf(f"{DATA}/franka_panda/panda.urdf", fixed_base=True)
        arm.joints.set_velocity_targets(0.3, max_forces=20.0)
    worlds = Worlds(scene, LANES, threads=1)
    worlds.step(2)
    (work,) = works_of(worlds)
    assert work is not None
    first, *others = work.workspaces
    for other in others:
        assert (other.pairs is first.pairs) is not touching
        for field in ("single_normal", "side", "row_terms"):
            memory = (one.structs["pair_rows"].memory[field] for one in (first, other))
            assert np.shares_memory(*memory) is (not touching and field != "row_terms")
        assert not np.shares_memory(
            other.scratch.numpy["delta_velocity"], first.scratch.numpy["delta_velocity"]
        )
