"""Equilibria of arms and of walkers that stand."""

from pathlib import Path

import numpy as np
import pytest
from tests.linearization.scenes import ASSETS, new_world, tighten

from carom import World
from carom.controllers import LQR, find_equilibrium

HOPPER = """
<mujoco>
  <option timestep="0.002"/>
  <worldbody>
    <geom type="plane" size="5 5 .1"/>
    <body name="torso" pos="0 0 0.75">
      <freejoint/>
      <geom type="box" size=".1 .1 .1" mass="3"/>
      <body name="leg" pos="0 0 -.1">
        <joint name="hip" type="hinge" axis="0 1 0" range="-60 60"/>
        <geom type="capsule" fromto="0 0 0 0 0 -.3" size=".03" mass="1"/>
        <body name="foot" pos="0 0 -.3">
          <joint name="ankle" type="hinge" axis="0 1 0" range="-60 60"/>
          <geom type="box" size=".15 .1 .02" pos="0 0 -.04" mass="1"/>
        </body>
      </body>
    </body>
  </worldbody>
  <actuator>
    <motor name="hip" joint="hip" gear="10"/>
    <motor name="ankle" joint="ankle" gear="10"/>
  </actuator>
  <keyframe><key name="stand" qpos="0 0 0.49 1 0 0 0 0.3 -0.3"/></keyframe>
</mujoco>"""


def test_an_arm_is_held_against_gravity():
    world = new_world()
    arm = world.load_urdf(f"{ASSETS}/kuka_iiwa/model.urdf", fixed_base=True)
    arm.joints.free()
    arm.joints.reset([0.3, 0.5, -0.4, -0.9, 0.2, 0.6, 0.1])
    before = world.position.copy()
    found = find_equilibrium(arm)
    assert world.position.tolist() == before.tolist()
    assert found.residual < 1e-6
    assert np.abs(found.positions - before).max() < 1e-3
    found.apply(world)
    for _ in range(20):
        arm.joints.set_torques(found.controls)
        world.step()
    assert np.abs(world.position - found.positions).max() < 1e-6


def test_a_hopper_stands_on_its_foot_and_is_held_there(tmp_path: Path):
    path = tmp_path / "hopper.xml"
    path.write_text(HOPPER)
    world = World()
    world.load(str(path))
    body = next(it for it in world.bodies.values() if it.name == "torso")
    found = find_equilibrium(body, "stand")
    assert found.residual < 1e-6
    found.apply(world)
    regulator = LQR(world, ["actuators"], state_cost=1.0, control_cost=1e-3, discount=0.999)
    world.velocity[:6] += [0.0, 0.02, 0.0, 0.0, 0.0, 0.0]
    for _ in range(500):
        regulator.apply()
        world.step()
    assert np.abs(regulator.difference()[:8]).max() < 0.05


def test_where_nothing_holds_that_is_said():
    world = new_world()
    body = world.load_urdf(f"{ASSETS}/r2d2.urdf", (0.0, 0.0, 3.0))
    body.joints.free()
    with pytest.raises(ValueError, match="no equilibrium was found near this pose"):
        find_equilibrium(body)


@pytest.mark.long
def test_a_quadruped_stands_on_rigid_contacts():
    world = World()
    world.gravity = (0.0, 0.0, -9.81)
    world.load_urdf(f"{ASSETS}/plane.urdf")
    body = world.load_urdf(f"{ASSETS}/a1/a1.urdf", (0.0, 0.0, 0.32))
    body.joints.free()
    body.joints.reset([0.0, 0.7, -1.4] * 4)
    found = find_equilibrium(body)
    assert found.residual < 1e-6
    found.apply(world)
    tighten(world)
    for _ in range(20):
        body.joints.set_torques(found.controls)
        world.step()
    assert np.abs(world.position - found.positions).max() < 1e-4
