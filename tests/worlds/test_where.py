"""Setters that change some of the worlds: the others stay as they are, and lengths have to fit."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from tests.physics.contact_scenes import add_box, add_floor, earth
from tests.worlds.same_bits import assert_same_bits

import pybullet_data
from carom import Body, World, Worlds
from carom.layouts.codes import UserConstraintKind
from carom.worlds.body import BodyBatch

COUNT = 5
CHOSEN = np.array([3, 1])
MASK = np.array([False, True, False, True, False])
BASE = -1


@pytest.fixture
def arm() -> tuple[World, Body]:
    world = earth()
    return world, world.load_urdf(f"{pybullet_data.getDataPath()}/franka_panda/panda.urdf", fixed_base=True)


def box() -> tuple[World, Body]:
    world = earth()
    add_floor(world)
    return world, add_box(world, (0.0, 0.0, 0.5))


def test_dynamics_change_where_they_are_to_and_can_be_read_back() -> None:
    world, cube = box()
    worlds = Worlds(world, COUNT)
    batch = worlds[cube]
    before = batch.dynamics(BASE)
    batch.change_dynamics(BASE, lateral_friction=[0.9, 0.7], restitution=0.25, where=CHOSEN)
    now = batch.dynamics(BASE)
    friction = float(before["lateral_friction"][0])
    assert now["lateral_friction"].tolist() == [friction, 0.7, friction, 0.9, friction]
    assert now["restitution"].tolist() == [0.0, 0.25, 0.0, 0.25, 0.0]
    batch.change_dynamics(BASE, lateral_friction=[0.1, 0.2], where=MASK)
    assert batch.dynamics(BASE)["lateral_friction"].tolist() == [friction, 0.1, friction, 0.2, friction]
    lone = world.copy()
    worlds.step(20)
    lone.step(20)
    for number in (0, 2, 4):
        assert_same_bits(worlds, number, lone)


def test_what_is_read_can_be_set_again(arm: tuple[World, Body]) -> None:
    world, panda = arm
    batch = Worlds(world, COUNT)[panda]
    batch.change_dynamics(2, mass=[2.0], joint_upper_limit=[0.5], where=[4])
    found = batch.dynamics("panda_link3")
    assert found["mass"].tolist()[-1] == 2.0
    assert found["inertia"].shape == (COUNT, 3)
    assert found["joint_upper_limit"].tolist() == [panda.joints[2].limits[1]] * 4 + [0.5]
    assert "mass" not in batch.dynamics(BASE)
    other = Worlds(world, COUNT)[panda]
    other.change_dynamics(2, **found)
    assert {name: values.tolist() for name, values in other.dynamics(2).items()} == {
        name: values.tolist() for name, values in found.items()
    }


def test_drives_change_where_they_are_to(arm: tuple[World, Body]) -> None:
    world, panda = arm
    worlds = Worlds(world, COUNT, threads=2)
    batch = worlds[panda]
    targets = np.random.default_rng(0).uniform(-0.5, 0.5, (2, 9))
    lone = [world.copy() for _ in range(COUNT)]
    joints = [one.bodies[panda.id].joints for one in lone]
    batch.joints.set_position_targets(targets, max_forces=[[80.0], [70.0]], where=CHOSEN)
    batch.joints[[2]].set_velocity_targets([[0.3], [0.4]], where=CHOSEN)
    batch.joints[["panda_joint1"]].set_springs(0.1, stiffness=5.0, damping=[[0.5], [0.6]], where=MASK)
    batch.joints.set_torques(np.ones((2, 9)), where=CHOSEN)
    batch.joints[[5, 3]].set_torques([[3.0, 4.0]], where=[1])
    batch.joints[[4]].free(where=[3])
    for place, number in enumerate(CHOSEN):
        joints[number].set_position_targets(targets[place], max_forces=80.0 - 10.0 * place)
        joints[number][2].set_velocity_target(0.3 + 0.1 * place)
        joints[number][0].set_spring(0.1, stiffness=5.0, damping=0.6 if number == 3 else 0.5)
        torques = np.ones(9)
        if number == 1:
            torques[[5, 3]] = 3.0, 4.0
        joints[number].set_torques(torques)
    joints[3][4].free()
    worlds.step(10)
    for number, one in enumerate(lone):
        one.step(10)
        assert_same_bits(worlds, number, one)


def test_drives_can_be_read_back_and_set_again(arm: tuple[World, Body]) -> None:
    world, panda = arm
    worlds = Worlds(world, COUNT)
    batch = worlds[panda]
    batch.joints[["panda_joint1", "panda_joint2"]].set_position_targets(
        [[0.1, -0.2], [0.3, -0.4]],
        gains=0.2,
        velocities=0.5,
        velocity_gains=0.7,
        max_forces=60.0,
        max_velocities=2.0,
        where=CHOSEN,
    )
    batch.joints[[2]].set_velocity_targets(-1.5, max_forces=24.0, where=CHOSEN)
    batch.joints[[0, 1]].set_springs([0.6, 0.8], stiffness=40.0, damping=3.0, max_forces=12.0, where=MASK)
    batch.joints[[3]].free(where=MASK)
    motors, springs = batch.joints.motors(), batch.joints[[0, 1]].springs()
    assert motors["targets"][:, :2].tolist() == [[0, 0], [0.3, -0.4], [0, 0], [0.1, -0.2], [0, 0]]
    stated = {
        "velocities": 0.5,
        "gains": 0.2,
        "velocity_gains": 0.7,
        "max_forces": 60.0,
        "max_velocities": 2.0,
    }
    for name, value in stated.items():
        np.testing.assert_allclose(motors[name][MASK, :2], value, rtol=1e-15)
    np.testing.assert_array_equal(motors["velocities"][MASK, 2], -1.5)
    np.testing.assert_array_equal(motors["gains"][MASK, 2], 0.0)
    np.testing.assert_array_equal(motors["max_forces"][MASK, 3], 0.0)
    assert springs["targets"].tolist() == [[0, 0], [0.6, 0.8], [0, 0], [0.6, 0.8], [0, 0]]
    for name, value in {"velocities": 0.0, "stiffness": 40.0, "damping": 3.0, "max_forces": 12.0}.items():
        np.testing.assert_array_equal(springs[name][MASK], value)
    other = Worlds(world, COUNT)
    other[panda].joints.set_position_targets(motors.pop("targets"), **motors)
    other[panda].joints[[0, 1]].set_springs(springs.pop("targets"), **springs)
    for name, value in batch.joints.motors().items():
        np.testing.assert_allclose(other[panda].joints.motors()[name], value, rtol=1e-15)


def test_forces_act_where_they_are_to() -> None:
    world, cube = box()
    worlds = Worlds(world, COUNT)
    worlds[cube].links[BASE].apply_force([[5.0, 0, 0], [0, 6.0, 0]], where=CHOSEN)
    worlds[cube].links[BASE].apply_torque((0, 0, 0.01), where=CHOSEN)
    worlds[cube].links[BASE].apply_force((1.0, 0.0, 0.0), (0.0, 0.0, 0.6), where=[1])
    worlds.step()
    velocities = worlds[cube].base_velocities
    assert (velocities[[0, 2, 4], :2] == 0.0).all()
    assert velocities[3, 0] > 0.0
    assert velocities[3, 1] == 0.0
    assert (velocities[1, :2] > 0.0).all()
    assert velocities[1, 4] > 0.0


def test_gravity_and_constraints_change_where_they_are_to() -> None:
    world, cube = box()
    world.constrain_links(UserConstraintKind.FIXED, cube, BASE, None, BASE)
    worlds = Worlds(world, COUNT)
    worlds.change_parameters(gravity=[[0.0, 0.0, -1.0], [0.0, 0.0, -2.0]], where=CHOSEN)
    assert worlds.gravity[:, 2].tolist() == [-9.81, -2.0, -9.81, -1.0, -9.81]
    worlds.constraints[0].enable([False, True], where=CHOSEN)
    assert worlds.constraints[0].enabled.tolist() == [True, True, True, False, True]
    worlds.constraints[0].enable(False, where=MASK)
    assert worlds.constraints[0].enabled.tolist() == [True, False, True, False, True]


_SETTERS: list[Callable[[Worlds, BodyBatch, object], None]] = [
    lambda _, arms, where: arms.change_dynamics(2, mass=np.ones(1), where=where),  # type: ignore[arg-type]
    lambda _, arms, where: arms.change_dynamics(2, inertia=np.ones((1, 3)), where=where),  # type: ignore[arg-type]
    lambda _, arms, where: arms.joints.set_position_targets(np.zeros((1, 9)), where=where),  # type: ignore[arg-type]
    lambda _, arms, where: arms.joints.set_velocity_targets(0.0, gains=np.ones((1, 9)), where=where),  # type: ignore[arg-type]
    lambda _, arms, where: arms.joints.set_springs(0.0, stiffness=1, damping=[[1.0]], where=where),  # type: ignore[arg-type]
    lambda _, arms, where: arms.joints.set_torques(np.zeros((1, 9)), where=where),  # type: ignore[arg-type]
    lambda _, arms, where: arms.set_base_inertial_poses(np.zeros((1, 3)), where=where),  # type: ignore[arg-type]
    lambda _, arms, where: arms.set_base_velocities(np.zeros((1, 6)), where=where),  # type: ignore[arg-type]
    lambda _, arms, where: arms.links[0].apply_force(np.zeros((1, 3)), where=where),  # type: ignore[arg-type]
    lambda worlds, _, where: worlds.change_parameters(gravity=np.zeros((1, 3)), where=where),  # type: ignore[arg-type]
]


@pytest.mark.parametrize("setter", _SETTERS)
def test_one_entry_is_not_spread_over_several_worlds(
    arm: tuple[World, Body], setter: Callable[[Worlds, BodyBatch, object], None]
) -> None:
    world, panda = arm
    worlds = Worlds(world, COUNT)
    with pytest.raises(ValueError, match=r"has shape \(1.*one entry for each of the 5 worlds, or"):
        setter(worlds, worlds[panda], None)
    with pytest.raises(ValueError, match=r"has shape \(1.*one entry for each of the 2 worlds chosen"):
        setter(worlds, worlds[panda], CHOSEN)
    setter(worlds, worlds[panda], [2])


def test_lengths_that_do_not_fit_are_refused_and_change_nothing() -> None:
    world, cube = box()
    batch = Worlds(world, COUNT)[cube]
    before = batch.dynamics(BASE)["lateral_friction"].tolist()
    with pytest.raises(ValueError, match=r"lateral_friction has shape \(5,\); it must have shape \(2,\)"):
        batch.change_dynamics(BASE, lateral_friction=np.ones(COUNT), where=CHOSEN)
    with pytest.raises(ValueError, match=r"as a mask it must have shape \(5,\)"):
        batch.change_dynamics(BASE, lateral_friction=1.0, where=[True, False])
    with pytest.raises(IndexError, match="there are worlds 0 to 4"):
        batch.change_dynamics(BASE, lateral_friction=1.0, where=[5])
    with pytest.raises(ValueError, match=r"mass must be a number or an array of numbers, not .*much"):
        batch.change_dynamics(BASE, mass="much")  # type: ignore[arg-type]
    assert batch.dynamics(BASE)["lateral_friction"].tolist() == before
