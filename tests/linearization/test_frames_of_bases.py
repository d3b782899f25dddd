"""Linearised steps of free bases whose centre of mass is not at the origin of their frame."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pytest
from tests.linearization.scenes import assert_exact
from tests.linearization.test_integrators import INTEGRATORS, of_file, stir

if TYPE_CHECKING:
    from pathlib import Path

ROBOT = """
<body name="trunk" pos="0 0 {height}" euler="10 20 30"><freejoint/>
  <geom type="box" size=".1 .2 .05" pos=".08 -.05 .12" euler="20 0 40" density="900" condim="3"/>
  <body pos=".1 0 .1">
    <joint name="a" axis="0 1 .2" damping=".3" stiffness="2" armature=".1"/>
    <geom type="capsule" fromto="0 0 0 .3 0 .1" size=".05"/>
    <body name="hand" pos=".3 0 .1">
      <joint name="s" type="ball" damping=".05" stiffness=".3" armature=".02"/>
      <geom type="capsule" fromto="0 0 0 .2 .1 .1" size=".05"/>
    </body>
  </body>
</body>
"""
SERVO = '<actuator><position joint="a" kp="2" kv=".3"/></actuator>'
LONE = """<body pos="0 0 1"><freejoint/>
  <geom type="box" size=".1 .2 .05" pos=".1 .02 -.07" density="500"/></body>"""


@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_a_robot_in_the_air(tmp_path: Path, integrator: str) -> None:
    world = of_file(tmp_path, integrator, ROBOT.format(height=2), SERVO)
    stir(world, 0, 3.0)
    step = assert_exact(
        world, controls=["actuators", "torques"], parameters=["masses", "inertias", "damping", "armature"]
    )
    assert step.method == "exact"


@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_a_lone_body_that_tumbles(tmp_path: Path, integrator: str) -> None:
    world = of_file(tmp_path, integrator, LONE)
    stir(world, 1, 8.0)
    assert_exact(world, controls=["torques"], parameters=["masses", "inertias"])


@pytest.mark.parametrize("integrator", INTEGRATORS)
@pytest.mark.parametrize("cone", ["pyramidal", "elliptic"])
def test_a_robot_that_touches_the_ground(tmp_path: Path, integrator: str, cone: str) -> None:
    bodies = '<geom type="plane" size="5 5 1"/>' + ROBOT.format(height=0.3)
    world = of_file(tmp_path, integrator, bodies, SERVO, f'cone="{cone}"')
    stir(world, 2, 2.0)
    for _ in range(200):
        if any(name.startswith("contact") for name, _ in world.linearize().rows):
            break
        world.step()
    step = assert_exact(world, controls=["actuators"])
    assert any(name.startswith("contact") for name, _ in step.rows)


@pytest.mark.parametrize("integrator", INTEGRATORS)
@pytest.mark.parametrize("tie", ['connect body1="trunk" anchor=".1 .1 0"', 'weld body1="hand"'])
def test_a_robot_that_the_world_holds(tmp_path: Path, integrator: str, tie: str) -> None:
    rest = f'<equality><{tie} solref=".05 1"/></equality>'
    world = of_file(tmp_path, integrator, ROBOT.format(height=2), rest)
    stir(world, 3, 2.0)
    assert_exact(world)


@pytest.mark.parametrize("integrator", ["explicit", "RK4"])
def test_inertia_of_a_tendon_to_the_world(tmp_path: Path, integrator: str) -> None:
    trunk = ROBOT.format(height=1).replace('damping=".3"', "")
    trunk = trunk.replace('damping=".05"', "").replace(
        "<freejoint/>", '<freejoint/><site name="p" pos=".1 .2 .1"/>'
    )
    tendon = '<tendon><spatial armature=".5"><site site="w"/><site site="p"/></spatial></tendon>'
    world = of_file(tmp_path, integrator, '<site name="w" pos=".5 .2 1.5"/>' + trunk, tendon)
    stir(world, 4, 2.0)
    assert_exact(world)


@pytest.mark.parametrize("integrator", ["Euler", "implicit"])
def test_passes_without_slip(tmp_path: Path, integrator: str) -> None:
    bodies = '<geom type="plane" size="5 5 1"/><body pos="0 0 .0987"><freejoint/>' + (
        '<geom type="sphere" size=".1" mass="1"/><geom type="box" size=".02 .02 .02" pos="0 .05 .1" '
        'contype="0" conaffinity="0" mass="1"/></body>'
    )
    world = of_file(tmp_path, integrator, bodies, "", 'noslip_iterations="50"')
    world.velocity[6:12] = 0.4, -2.0, 1.2, 0.3, 0.1, -0.02
    step = assert_exact(world)
    assert any(name.startswith("contact") for name, _ in step.rows)


def test_inertial_parameters_of_such_a_base_are_refused(tmp_path: Path) -> None:
    world = of_file(tmp_path, "Euler", LONE)
    with pytest.raises(NotImplementedError, match="move its centre of mass"):
        world.linearize(method="exact", parameters=["inertial_parameters"])
    assert np.isfinite(world.linearize(method="exact").A).all()


@pytest.mark.parametrize("integrator", ["implicitfast", "implicit"])
def test_servos_at_the_bounds_of_their_joints_do_not_damp(tmp_path: Path, integrator: str) -> None:
    limb = """<body pos="0 0 1"><joint name="a" axis="0 1 0" damping=".1" actuatorfrcrange="{} .5"/>
      <geom type="capsule" fromto="0 0 0 .3 0 .1" size=".05"/></body>"""
    servos = '<actuator><position joint="a" kp="30" kv="3"/><velocity joint="a" kv=".5"/></actuator>'
    damped = []
    for lower in (-0.5, -500.0):
        world = of_file(tmp_path, integrator, limb.format(lower), servos)
        next(iter(world)).joints.positions, world.velocity[6] = [0.9], 1.5
        step = assert_exact(world, controls=["actuators"])
        damped.append(step.A[1, 1])
    assert damped[0] > 0.99 > damped[1]
