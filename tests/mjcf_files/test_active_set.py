"""Islands whose contacts yield: the rows that hold are solved for between sweeps."""

from __future__ import annotations

import numpy as np
import pytest

import pybullet_data
from carom import Body, Motor, World

DATA = pybullet_data.getDataPath()
STRENGTHS = {"ant": 150.0, "humanoid": 40.0}


def scene(robot: str) -> tuple[World, Body]:
    """A robot of an MJCF file on a floor, with motors."""
    world = World()
    world.gravity = (0.0, 0.0, -9.81)
    bodies = world.load(f"{DATA}/mjcf/{robot}.xml").bodies
    body = next(one for one in bodies if one.joint_count)
    if len(bodies) == 1:
        world.add_plane()
    for joint in body.joints:
        if joint.degrees_of_freedom == 1:
            body.add_actuator(joint.name, Motor(joint.name, gear=STRENGTHS[robot]))
    return world, body


def sweeps(world: World) -> int:
    return int(world.engine.arrays.state.numpy["tree_iterations"][0].max())


def drive(world: World, body: Body, generator: np.random.Generator) -> None:
    body.actuators.controls = generator.uniform(-1.0, 1.0, len(body.actuators.controls))


@pytest.mark.parametrize(("robot", "most"), [("ant", 12.0), ("humanoid", 18.0)])
def test_few_sweeps_are_enough(robot: str, most: float) -> None:
    # Sweeps alone were 29 for an Ant, and 27 for a Humanoid.
    world, body = scene(robot)
    generator = np.random.default_rng(7)
    counts = []
    for step in range(600):
        if step % 20 == 0:
            drive(world, body, generator)
        world.step()
        counts.append(sweeps(world))
    assert np.mean(counts) < most


def test_the_solution_is_the_fixed_point_of_the_sweeps() -> None:
    world, body = scene("ant")
    generator = np.random.default_rng(3)
    apart, converged = [], 0
    for step in range(300):
        if step % 20 == 0:
            drive(world, body, generator)
        before = world.snapshot()
        # A residual this small after a sweep means that no row, by itself, wants to change.
        world.parameters.solver_iterations, world.parameters.solver_residual_threshold = 2_000, 1e-20
        world.step()
        converged += sweeps(world) < 2_000
        exact = world.engine.arrays.state.numpy["dof_velocity"][0].copy()
        world.restore(before)
        world.parameters.solver_iterations, world.parameters.solver_residual_threshold = 50, 1e-7
        world.step()
        apart.append(np.abs(world.engine.arrays.state.numpy["dof_velocity"][0] - exact).max())
    assert converged >= 295
    assert np.quantile(apart, 0.9) < 1e-3


def test_a_robot_at_rest_stays_there() -> None:
    world, _body = scene("ant")
    for _ in range(1_500):
        world.step()
    assert np.abs(world.engine.arrays.state.numpy["dof_velocity"][0]).max() < 1e-3
    assert sweeps(world) <= 9
