"""Worlds whose rows are relaxed several at a time are bit for bit those that they would be alone."""

from __future__ import annotations

import ctypes
from collections.abc import Callable

import numpy as np
import pytest
from tests.physics.contact_scenes import earth
from tests.worlds.same_bits import assert_all_same_bits, assert_same_bits, stirred, stirred_worlds
from tests.worlds.test_lanes import works_of
from tests.worlds.test_presence import DATA

from carom import Body, Motor, PositionActuator, World, Worlds
from carom.layouts.programs import LANES

_HOME = (0.0, -0.7, 0.0, -2.2, 0.0, 1.6, 0.8, 0.02, 0.02)


def arm(servos: bool = True) -> tuple[World, Body]:
    """An arm with a coupling of its fingers, and servos, which yield, or torques."""
    world = earth()
    body = world.load_urdf(f"{DATA}/franka_panda/panda.urdf", fixed_base=True)
    body.joints.reset(_HOME)
    for joint in (joint.name for joint in body.joints if joint.degrees_of_freedom == 1):
        body.add_actuator(joint, PositionActuator(joint, kp=400.0, kv=40.0) if servos else Motor(joint))
    return world, body


def controlled(scene: World, body: Body, count: int, threads: int = 1) -> tuple[Worlds, list[World]]:
    """Worlds with controls of their own, some of which push joints against limits, and each world alone."""
    worlds = stirred_worlds(scene, count, threads)
    controls = np.random.default_rng(3).uniform(-4.0, 4.0, worlds[body].actuators.controls.shape)
    worlds[body].actuators.controls[:] = controls
    alone = [stirred(scene, number) for number in range(count)]
    for world, control in zip(alone, controls, strict=True):
        world.arrays.state.numpy["actuator_control"][0, : len(control)] = control
    return worlds, alone


def sweeps_of(worlds: Worlds) -> int:
    return sum(work.sweeps.begun for work in works_of(worlds) if work)


def rows_of(worlds: Worlds) -> np.ndarray:
    """How many joints are beyond a limit, by world."""
    engine = worlds._engine
    position = engine.arrays.state.numpy["position"]
    model = engine.arrays.model.numpy
    count = engine.arrays.used["constraint"]
    places = model["link_first_position"][model["constraint_link"][:count]]
    limits = model["constraint_kind"][:count] == 1
    at = position[:, places]
    beyond = (at <= model["constraint_lower"][:, :count]) | (at >= model["constraint_upper"][:, :count])
    return (beyond & limits).sum(axis=1)


def assert_same_motion(worlds: Worlds, others: Worlds) -> None:
    for name in ("position", "dof_velocity", "user_impulse", "actuator_force", "tree_iterations"):
        ours, theirs = (one._engine.arrays.state.numpy[name] for one in (worlds, others))
        np.testing.assert_array_equal(ours, theirs, err_msg=name)


@pytest.mark.parametrize("servos", [True, False])
@pytest.mark.parametrize(("count", "threads"), [(4, 1), (9, 1), (9, 2)])
def test_worlds_with_different_rows(count: int, threads: int, servos: bool) -> None:
    scene, body = arm(servos)
    worlds, alone = controlled(scene, body, count, threads)
    differed = False
    # In the first step arrays of rows grow.
    for steps in (1, 20, 40, 60):
        begun = sweeps_of(worlds)
        worlds.step(steps)
        assert (sweeps_of(worlds) > begun) == (steps > 1)
        differed = differed or len(np.unique(rows_of(worlds)[:LANES])) > 1
        assert_all_same_bits(worlds, alone, steps)
    assert differed


@pytest.mark.parametrize("threads", [1, 2])
def test_worlds_whose_bodies_cannot_interact(threads: int) -> None:
    scene = earth()
    body = scene.load_urdf(f"{DATA}/franka_panda/panda.urdf", fixed_base=True, as_pybullet=True)
    body.joints.reset(_HOME)
    body.joints.set_position_targets(_HOME, max_forces=87.0)
    worlds = stirred_worlds(scene, 9, threads)
    alone = [stirred(scene, number) for number in range(9)]
    for steps in (1, 20, 40):
        worlds.step(steps)
        assert_all_same_bits(worlds, alone, steps)
    assert sweeps_of(worlds) > 0


def joint_motors(world: World, body: Body) -> None:
    body.joints.set_velocity_targets(0.3, max_forces=20.0)


def weak_motors(world: World, body: Body) -> None:
    body.joints.set_velocity_targets(3.0, max_forces=0.1)


def several_sweeps_inside(world: World, body: Body) -> None:
    world.parameters.noncontact_inner_iterations = 3


def no_sweeps(world: World, body: Body) -> None:
    world.parameters.solver_iterations = 0


@pytest.mark.parametrize("change", [joint_motors, weak_motors, several_sweeps_inside, no_sweeps])
def test_other_motors_and_settings(change: Callable[[World, Body], None]) -> None:
    scene, body = arm()
    change(scene, body)
    worlds, alone = controlled(scene, body, 5)
    for steps in (1, 29):
        worlds.step(steps)
    assert (sweeps_of(worlds) > 0) == (change in (joint_motors, weak_motors))
    assert_all_same_bits(worlds, alone, 30)


def test_a_coupling_that_some_worlds_lack() -> None:
    scene, body = arm()
    together, one_by_one = (controlled(scene, body, 4)[0] for _ in range(2))
    for worlds in (together, one_by_one):
        worlds._engine.set_parameter("users", "user_enabled", 0, np.array([1, 1, 0, 1]))
    for steps in (1, 29):
        together.step(steps)
        for number in range(4):
            one_by_one.step(steps, where=[number])
    assert sweeps_of(together) == 0
    assert_same_motion(together, one_by_one)


def test_a_world_that_fails_leaves_the_others_alone() -> None:
    scene, body = arm()
    worlds, alone = controlled(scene, body, 4)
    worlds.step(5)
    dof = int(scene.arrays.model.numpy["tree_first_dof"][body.rows.tree])
    worlds._engine.arrays.state.numpy["dof_velocity"][2, dof] = np.nan
    with pytest.warns(match="2"):
        worlds.step(10)
    for number in (0, 1, 3):
        alone[number].step(15)
        assert_same_bits(worlds, number, alone[number])


def test_settings_that_change() -> None:
    scene, body = arm()
    together, one_by_one = (controlled(scene, body, 4)[0] for _ in range(2))
    for seconds in (1 / 240, 1 / 60, 1 / 500):
        for worlds in (together, one_by_one):
            worlds.time_step = seconds
        for steps in (1, 7):
            together.step(steps)
            for number in range(4):
                one_by_one.step(steps, where=[number])
        assert_same_motion(together, one_by_one)
    assert sweeps_of(together) > 0


def test_given_torques_are_left_out_of_all_but_the_first_sweeps() -> None:
    scene, body = arm(servos=False)
    worlds, _ = controlled(scene, body, LANES)
    for steps in (1, 20):
        worlds.step(steps)
    (work,) = works_of(worlds)
    assert work is not None
    visits = ctypes.c_int32.from_address(work.sweeps.record.visits).value
    assert sweeps_of(worlds) > 2 * 20
    assert visits < len(_HOME)
