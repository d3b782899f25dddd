"""Worlds whose constraints converge take their free motion several at a time: each has its bits."""

from __future__ import annotations

import numpy as np
import pytest
from tests.integrators.scenes import file_of
from tests.worlds.same_bits import assert_as_stirred, assert_same_bits, stirred, stirred_worlds
from tests.worlds.test_presence import DATA

from carom import Body, World
from carom.layouts.contacts import THERE

ROBOT = """
<mujoco model="walking table">
  <option timestep="0.004" integrator="{integrator}"/>
  <default><geom condim="3" friction=".8 .01 .001"/></default>
  <worldbody>
    <geom type="plane" size="0 0 1"/>
    <body name="table" pos="0 0 .42">
      <freejoint/>
      <geom type="box" size=".3 .2 .04" mass="4"/>
      <site name="middle"/>
      {legs}
    </body>
    <body name="ball" pos=".1 0 .6"><freejoint/><geom type="ellipsoid" size=".05 .07 .06" mass=".4"/></body>
  </worldbody>
  <tendon><spatial name="cord" stiffness="30" damping="2">
    <site site="foot0"/><site site="foot3"/></spatial></tendon>
  <actuator>{servos}</actuator>
  <sensor><force site="foot1"/><accelerometer site="middle"/><torque site="foot2"/></sensor>
</mujoco>
"""
LEG = """<body name="leg{k}" pos="{x} {y} -.02">
  <joint name="hip{k}" axis="1 0 0" damping=".4" armature=".01" range="-1 1" limited="true"/>
  <joint name="turn{k}" axis="0 1 0" damping=".2" frictionloss=".05"/>
  <geom type="capsule" fromto="0 0 0 0 0 -.2" size=".025" mass=".3"/>
  <body pos="0 0 -.2"><joint name="knee{k}" axis="0 1 0" stiffness="5"/>
    <geom type="capsule" fromto="0 0 0 0 0 -.16" size=".02" mass=".2"/><site name="foot{k}" pos="0 0 -.16"/>
  </body></body>"""


def walking_table(integrator: str) -> tuple[World, Body]:
    """Four legs of three joints with servos, damping, armature, a tendon and sensors, under an egg."""
    places = [(x, y) for x in (-0.25, 0.25) for y in (-0.15, 0.15)]
    legs = "".join(LEG.format(k=k, x=x, y=y) for k, (x, y) in enumerate(places))
    servos = "".join(
        f'<position joint="{joint}{k}" kp="40" kv="2" forcerange="-20 20"/>'
        for k in range(4)
        for joint in ("hip", "turn", "knee")
    )
    world = World()
    world.load(ROBOT.format(integrator=integrator, legs=legs, servos=servos))
    return world, next(body for body in world if body.joint_count)


def on_a_plane(name: str) -> tuple[World, Body]:
    """A robot of the package that falls on a plane, by the integrator of `carom`'s own worlds."""
    world = World()
    world.gravity = (0.0, 0.0, -9.81)
    world.add_plane()
    return world, world.load_urdf(f"{DATA}/{name}.urdf", (0.0, 0.0, 0.6))


@pytest.mark.parametrize("integrator", ["Euler", "implicitfast", "implicit"])
def test_files_with_an_integrator(integrator: str) -> None:
    scene, robot = walking_table(integrator)
    worlds = stirred_worlds(scene, 5, threads=1)
    alone = [stirred(scene, number) for number in range(5)]
    random, there = np.random.default_rng(3), []
    for steps in (1, 5, 30, 40):
        controls = random.uniform(-0.6, 0.6, worlds[robot].actuators.controls.shape)
        worlds[robot].actuators.controls[:] = controls
        worlds.step(steps)
        for number, (lone, control) in enumerate(zip(alone, controls, strict=True)):
            lone.arrays.state.numpy["actuator_control"][0, : len(control)] = control
            lone.step(steps)
            assert_same_bits(worlds, number, lone)
        # What joints bear is found when it is read.
        np.testing.assert_array_equal(worlds.sensors, [np.asarray(lone.sensors) for lone in alone])
        there.append(worlds._engine.contact_arrays.contacts.numpy["count_contacts"][:, THERE].copy())
    assert np.ptp(np.array(there)) > 0
    assert worlds._engine.steps_in_lanes > 0


@pytest.mark.parametrize("integrator", ["Euler", "implicitfast"])
@pytest.mark.parametrize("tie", ["connect", "weld"])
def test_ties_of_links_that_turn(tie: str, integrator: str) -> None:
    where = 'anchor="0 0 -.3"' if tie == "connect" else ""
    arms = "".join(
        f"""<body name="{name}0" pos="{x} 0 0"><joint name="{name}a" axis="0 1 0" damping=".01"/>
          <geom type="capsule" fromto="0 0 0 0 0 -.3" size=".02" mass="1"/>
          <body name="{name}1" pos="0 0 -.3"><joint name="{name}b" axis="1 .2 0"/>
            <geom type="capsule" fromto="0 0 0 0 0 -.3" size=".02" mass=".5"/></body></body>"""
        for name, x in (("left", 0.0), ("right", 0.05))
    )
    scene = World()
    scene.load(f"""<mujoco><option integrator="{integrator}"><flag contact="disable"/></option>
      <worldbody>{arms}</worldbody>
      <equality><{tie} body1="left1" body2="right1" {where}/></equality></mujoco>""")
    for body, turns in zip(scene, (3.0, -2.0), strict=False):
        body.joints.velocities = (turns, 5.0)
    worlds = stirred_worlds(scene, 4, threads=1)
    worlds.step(40)
    assert worlds._engine.steps_in_lanes > 0
    assert_as_stirred(worlds, scene, 40)


@pytest.mark.parametrize("integrator", ["Euler", "implicitfast", "implicit"])
@pytest.mark.parametrize("name", ["falling off its frame", "tied off its frame"])
def test_bases_that_move_by_their_frames(name: str, integrator: str) -> None:
    scene = World()
    content = scene.load(file_of(name, integrator))
    content.reset(next(iter(content.keyframes)))
    worlds = stirred_worlds(scene, 5, threads=1)
    worlds.step(60)
    assert worlds._engine.steps_in_lanes > 0
    assert_as_stirred(worlds, scene, 60)


@pytest.mark.parametrize("law", ["compliant", "rigid"])
@pytest.mark.parametrize("name", ["r2d2", "laikago/laikago_toes"])
def test_worlds_without_an_integrator(name: str, law: str) -> None:
    scene, robot = on_a_plane(name)
    scene.contact = law
    robot.joints.set_velocity_targets(0.3, max_forces=5.0)
    worlds = stirred_worlds(scene, 4, threads=2)
    for steps in (1, 9, 60, 40):
        worlds.step(steps)
    assert worlds._engine.steps_in_lanes > 0
    assert_as_stirred(worlds, scene, 110)


def test_stages_of_runge_and_kutta_are_taken_alone() -> None:
    scene, _ = walking_table("RK4")
    worlds = stirred_worlds(scene, 4, threads=1)
    worlds.step(8)
    assert worlds._engine.steps_in_lanes == 0
    lone = stirred(scene, 1)
    lone.step(8)
    assert_same_bits(worlds, 1, lone)
