"""Islands whose contacts yield: the rows that hold are solved for between sweeps."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import pybullet_data
from carom import Body, Motor, World

DATA = pybullet_data.getDataPath()
STRENGTHS = {"ant": 150.0, "humanoid": 40.0}


def scene(robot: str) -> tuple[World, Body]:
    """A robot of an MJCF file on a floor, with motors."""
    world = World(gravity=(0.0, 0.0, -9.81), contact="bullet")
    bodies = world.load_mjcf(f"{DATA}/mjcf/{robot}.xml")
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


@pytest.mark.parametrize(("robot", "most"), [("ant", 4.8), ("humanoid", 8.8)])
def test_few_sweeps_are_enough(robot: str, most: float) -> None:
    # Sweeps alone are 29 for an Ant, and 27 for a Humanoid; with them, but from zero impulses, 5.0 and 9.2.
    world, body = scene(robot)
    generator = np.random.default_rng(7)
    counts = []
    for step in range(600):
        if step % 20 == 0:
            drive(world, body, generator)
        world.step()
        counts.append(sweeps(world))
    assert np.mean(counts) < most


@pytest.mark.parametrize("robot", ["ant", "humanoid"])
def test_the_solution_is_the_fixed_point_of_the_sweeps(robot: str) -> None:
    world, body = scene(robot)
    generator = np.random.default_rng(3)
    apart, converged = [], 0
    for step in range(300):
        if step % 20 == 0:
            drive(world, body, generator)
        before = world.snapshot()
        # A residual this small after a sweep means that no row, by itself, wants to change.
        world.change_parameters(solver_iterations=2_000, solver_residual_threshold=1e-20)
        world.step()
        converged += sweeps(world) < 2_000
        exact = world.engine.arrays.state.numpy["dof_velocity"][0].copy()
        world.restore(before)
        world.change_parameters(solver_iterations=50, solver_residual_threshold=1e-7)
        world.step()
        apart.append(np.abs(world.engine.arrays.state.numpy["dof_velocity"][0] - exact).max())
    assert converged == 300
    assert np.median(apart) > 0.0
    assert np.quantile(apart, 0.9) < 6e-4


@pytest.mark.parametrize(
    "parameters", [{"solver_iterations": 0}, {"solver_iterations": 3}, {"contact_warm_starting": 0.0}]
)
def test_impulses_start_from_zero_where_nothing_is_solved_for(parameters: dict[str, float]) -> None:
    world, _body = scene("ant")
    for _ in range(200):
        world.step()
    world.change_parameters(**parameters)
    velocities = []
    before = world.snapshot()
    for share in (1.0, 0.0):
        world.restore(before)
        impulses = world.engine.contact_arrays.contacts.numpy["contact_impulse"]
        assert (impulses[..., 0] > 0.0).any()
        impulses *= share
        world.step()
        velocities.append(world.engine.arrays.state.numpy["dof_velocity"][0].copy())
    np.testing.assert_array_equal(*velocities)


def test_a_robot_at_rest_stays_there() -> None:
    world, _body = scene("ant")
    # It creeps into its springs for a while: each of these steps is solved to rounding.
    for _ in range(2_500):
        world.step()
    assert np.abs(world.engine.arrays.state.numpy["dof_velocity"][0]).max() < 1e-3
    assert world.engine.arrays.state.numpy["tree_residual"][0].max() < 1e-20
    assert sweeps(world) <= 5


def test_robots_that_do_not_touch_are_solved_each_by_itself() -> None:
    world, body = scene("ant")
    second = next(one for one in world.load(f"{DATA}/mjcf/ant.xml").bodies if one.joint_count)
    second.set_inertial_pose((9.0, 0.0, 0.75), (0.0, 0.0, 0.0, 1.0))
    lone, same = scene("ant")
    generator = np.random.default_rng(5)
    for step in range(150):
        if step % 20 == 0:
            drive(world, body, generator)
            same.actuators.controls = body.actuators.controls
        world.step()
        lone.step()
    np.testing.assert_allclose(body.coordinates(), same.coordinates(), rtol=0.0, atol=1e-9)


CRANK = """
<mujoco>
  <worldbody>
    <geom type="plane" size="5 5 1" friction="{friction}"/>
    <body pos="0 0 {height}">
      <freejoint/>
      <geom type="box" size="0.3 0.2 0.1" density="400" friction="{friction}"/>
      <body pos="0 0 0.2">
        <joint type="hinge" axis="0 0 1"/>
        <geom type="box" size="0.1 0.02 0.02" pos="0.1 0 0"/>
      </body>
    </body>
  </worldbody>
</mujoco>
"""


def crank(folder: Path, height: float, friction: float) -> World:
    """A box with a bar on a hinge: its four corners have rows that depend on each other."""
    path = folder / "crank.xml"
    dimensions = 3 if friction else 1
    path.write_text(
        CRANK.format(height=height, friction=friction).replace("<geom ", f'<geom condim="{dimensions}" ')
    )
    world = World(gravity=(0.0, 0.0, -9.81), contact="bullet")
    world.load_mjcf(path)
    return world


@pytest.mark.parametrize("friction", [0.0, 0.7])
def test_rows_that_depend_on_each_other(tmp_path: Path, friction: float) -> None:
    # Four normals hold a box of six dofs, whose twelve rows are more than it has; without friction there are
    # normals only.
    world = crank(tmp_path, 0.1, friction)
    for _ in range(300):
        world.step()
    velocity = world.engine.arrays.state.numpy["dof_velocity"][0]
    assert np.isfinite(velocity).all()
    assert np.abs(velocity).max() < 1e-3
    assert sweeps(world) <= 20


def test_contacts_that_slide_are_solved_for_as_well() -> None:
    # The directions of friction turn, as the Ant does: the first set settles them, the second all the rest.
    world, body = scene("ant")
    for _ in range(300):
        world.step()
    counts = []
    for _ in range(10):
        body.set_base_velocity((3.0, 1.0, 0.0), (0.0, 0.0, 1.0))
        for _ in range(5):
            world.step()
            counts.append(sweeps(world))
    assert np.mean(counts) < 6.0


def test_contacts_that_do_not_push(tmp_path: Path) -> None:
    world = crank(tmp_path, 0.1, 0.7)
    box = next(one for one in world.bodies.values() if one.joint_count)
    box.set_base_velocity((0.0, 0.0, 3.0), (0.0, 0.0, 0.0))
    world.step()
    velocity = np.asarray(world.engine.arrays.state.numpy["dof_velocity"][0])
    # Nothing holds it: it has only gravity's change of its velocity.
    assert np.abs(velocity).max() == pytest.approx(3.0 - 9.81 / 240.0, abs=2e-2)
