"""Robots on their feet, many at a time, are bit for bit those that they would be alone."""

from __future__ import annotations

import numpy as np
import pytest
from tests.physics.contact_scenes import earth
from tests.worlds.same_bits import assert_same_bits, stirred, stirred_worlds
from tests.worlds.test_presence import DATA

from carom import Body, Motor, World
from carom.layouts.contacts import LIST_KIND, THERE

_STRENGTH = {"ant": 150.0, "humanoid": 40.0, "laikago": 30.0}


def on_a_floor(name: str) -> tuple[World, Body]:
    """A robot with a torque at each hinge, just above a floor."""
    world = earth()
    world.add_plane()
    if name == "laikago":
        robot = world.load_urdf(f"{DATA}/laikago/laikago_toes.urdf", (0.0, 0.0, 0.5))
    else:
        robot = next(body for body in world.load(f"{DATA}/mjcf/{name}.xml").bodies if body.joint_count)
    for joint in [joint.name for joint in robot.joints if joint.degrees_of_freedom == 1]:
        robot.add_actuator(joint, Motor(joint, gear=_STRENGTH[name]))
    # With such torques at random, legs turn so fast that steps of 1/240 s don't hold them together.
    robot.change_dynamics(-1, max_joint_velocity=100.0)
    return world, robot


@pytest.mark.parametrize(("name", "count", "threads"), [("ant", 9, 2), ("humanoid", 5, 1), ("laikago", 4, 1)])
def test_torques_that_change_while_contacts_come_and_go(name: str, count: int, threads: int) -> None:
    scene, robot = on_a_floor(name)
    worlds = stirred_worlds(scene, count, threads)
    alone = [stirred(scene, number) for number in range(count)]
    random, there = np.random.default_rng(5), []
    for steps in (1, 7, 20, 20, 20, 30):
        controls = random.uniform(-1.0, 1.0, worlds[robot].actuators.controls.shape)
        worlds[robot].actuators.controls[:] = controls
        worlds.step(steps)
        for number, (lone, control) in enumerate(zip(alone, controls, strict=True)):
            lone.arrays.state.numpy["actuator_control"][0, : len(control)] = control
            lone.step(steps)
            assert_same_bits(worlds, number, lone)
        there.append(worlds._engine.contact_arrays.contacts.numpy["count_contacts"][:, THERE].copy())
    numbers = np.array(there)
    assert (np.ptp(numbers, axis=0) > 0).all()
    assert (np.ptp(numbers, axis=1) > 0).any()
    assert worlds._engine.steps_in_lanes > 0


def test_a_list_of_pairs_serves_all_worlds_of_a_thread() -> None:
    scene, robot = on_a_floor("ant")
    worlds = stirred_worlds(scene, 8, threads=1)
    worlds[robot].actuators.controls[:] = np.random.default_rng(5).uniform(
        -1.0, 1.0, worlds[robot].actuators.controls.shape
    )
    for _ in range(6):
        worlds.step(20)
    assert worlds._engine.workspace.pairs.numpy["count_pairs"][0, LIST_KIND] == 2
