"""Linearised steps of MuJoCo's integrators with parts that few robots have, beside central differences."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from tests.linearization.scenes import assert_exact, excite, motors_off, tighten
from tests.linearization.test_integrators import INTEGRATORS, ROBOT, of_file, stir

from carom import Accelerometer, Gyro, World

NAMES = ["euler", "implicitfast", "implicit", "rk4"]
PLANAR = """
<robot name="slider"><link name="base"/>
  <link name="puck"><inertial><origin xyz=".05 .02 .01"/><mass value="2"/>
    <inertia ixx=".02" ixy=".003" ixz="0" iyy=".03" iyz="0" izz=".04"/></inertial></link>
  <link name="flag"><inertial><origin xyz="0 .1 .2"/><mass value="1"/>
    <inertia ixx=".02" ixy="0" ixz="0" iyy=".03" iyz="0" izz=".01"/></inertial></link>
  <joint name="plane" type="planar"><parent link="base"/><child link="puck"/><axis xyz="0 .2 1"/></joint>
  <joint name="turn" type="continuous"><parent link="puck"/><child link="flag"/><origin xyz=".1 0 .1"/>
    <axis xyz="1 0 0"/><dynamics damping=".3"/></joint>
</robot>
"""


@pytest.mark.parametrize("integrator", NAMES)
@pytest.mark.parametrize("fixed", [True, False])
def test_planar_joints(tmp_path: Path, integrator: str, fixed: bool) -> None:
    file = tmp_path / "slider.urdf"
    file.write_text(PLANAR)
    world = World(contact="compliant", integrator=integrator)
    world.gravity = (0.5, -0.3, -9.81)
    tighten(world)
    body = world.load_urdf(file, fixed_base=fixed)
    motors_off(body)
    excite(body, 4, 2.0)
    assert_exact(world, controls=["torques"])


@pytest.mark.parametrize("integrator", ["Euler", "RK4"])
def test_a_fluid(tmp_path: Path, integrator: str) -> None:
    world = of_file(
        tmp_path, integrator, ROBOT.format(base="<freejoint/>"), option='density="900" wind="1 0 0"'
    )
    stir(world, 2)
    assert_exact(world)


@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_a_limit_and_friction_of_a_ball_joint_beside_a_gear(tmp_path: Path, integrator: str) -> None:
    more = '<equality><joint joint1="a" joint2="b" polycoef="0 .5 .3 0 0" solref=".03 1"/></equality>'
    bodies = ROBOT.format(base="").replace(
        'type="ball"', 'type="ball" limited="true" range="0 2" frictionloss=".01"'
    )
    world = of_file(tmp_path, integrator, bodies, more)
    stir(world, 3)
    ball = next(iter(world.bodies.values())).position_index[1]
    world.position[ball : ball + 4] = 0.1, 0.2, 0.1, np.sqrt(0.94)
    step = assert_exact(world, controls=["torques"])
    assert {name.split()[0] for name, _ in step.rows} >= {"coupling", "limit", "friction"}


@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_activations_at_their_bounds(tmp_path: Path, integrator: str) -> None:
    actuator = (
        '<actuator><general joint="a" dyntype="integrator" actlimited="true" actrange="-1 .004" gainprm="2"/>'
        '<general joint="b" dyntype="filter" dynprm=".02" ctrlrange="-1 .1" gainprm="2"/></actuator>'
    )
    world = of_file(tmp_path, integrator, ROBOT.format(base=""), actuator)
    stir(world, 0)
    step = assert_exact(world, controls=["actuators"])
    # The first has arrived at its bound, the second has a control beyond its range.
    assert not step.A[-2].any()
    assert not step.B[:, 1].any()


@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_readings_of_sensors(tmp_path: Path, integrator: str) -> None:
    world = of_file(tmp_path, integrator, ROBOT.format(base="<freejoint/>"))
    body = next(iter(world.bodies.values()))
    body.add_site("tip", 2)
    body.add_sensor("gyro", Gyro(site="tip"))
    body.add_sensor("pull", Accelerometer(site="tip"))
    stir(world, 1)
    exact = world.linearize(outputs=body.sensors, method="exact")
    near = world.linearize(outputs=body.sensors, method="differences")
    for name in ("C", "D"):
        found, wanted = getattr(exact, name), getattr(near, name)
        assert np.abs(found - wanted).max() < 1e-5 * np.abs(wanted).max()


def test_air_damping_that_is_implicit_is_refused(tmp_path: Path) -> None:
    file = tmp_path / "slider.urdf"
    file.write_text(PLANAR)
    world = World(contact="compliant", integrator="implicit")
    body = world.load_urdf(file, fixed_base=True)
    world.arrays.model.numpy["tree_angular_damping"][:, body.rows.tree] = 0.04
    with pytest.raises(NotImplementedError, match="air damping of 'slider'"):
        world.linearize(method="exact")
