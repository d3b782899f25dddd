"""Nothing holds the speed of bodies of the modern API; those of the drop-in stay below 100, as in Bullet."""

from __future__ import annotations

from math import exp, inf
from pathlib import Path

import numpy as np
import pytest

import pybullet as p
from carom import World, Worlds

ROTOR = """<mujoco><option timestep="0.004"/><worldbody><body name="rotor" pos="0 0 1">
<joint name="spin" axis="0 0 1" damping="1e-4"/><geom type="cylinder" size=".1 .005" mass=".1"/>
</body></worldbody><actuator><motor name="m" joint="spin"/></actuator></mujoco>"""
INERTIA, DAMPING, TORQUE = 0.5 * 0.1 * 0.1**2, 1e-4, 0.05


@pytest.fixture
def rotor(tmp_path: Path) -> World:
    path = tmp_path / "rotor.xml"
    path.write_text(ROTOR)
    world = World()
    scene = world.load(path)
    scene["rotor"].actuators["m"].control = TORQUE
    return world


def test_a_rotor_reaches_the_speed_of_its_torque(rotor: World):
    rotor.step(1000)
    wanted = TORQUE / DAMPING * (1.0 - exp(-DAMPING / INERTIA * rotor.time))
    assert wanted > 270.0
    assert rotor["rotor"].joints["spin"].velocity == pytest.approx(wanted, rel=1e-3)


def test_worlds_and_saved_worlds_have_no_bound_either(rotor: World, tmp_path: Path):
    rotor.save(tmp_path / "saved")
    loaded = World()
    loaded.load_saved(tmp_path / "saved")
    loaded["rotor"].actuators["m"].control = TORQUE
    worlds = Worlds(rotor, 2)
    for stepped in (rotor, loaded, worlds):
        stepped.step(1000)
    fast = rotor["rotor"].joints.velocities
    assert fast[0] > 270.0
    assert np.array_equal(loaded["rotor"].joints.velocities, fast)
    assert np.array_equal(worlds["rotor"].joints.velocities, [fast, fast])


def test_a_projectile_flies_on():
    world = World()
    ball = world.add_sphere(0.02, (0.0, 0.0, 1.0))
    ball.set_base_velocity((700.0, 0.0, -300.0), (0.0, 400.0, 0.0))
    world.step(240)
    assert ball.pose.position == pytest.approx([700.0, 0.0, -299.0])
    assert ball.links.base.velocity.angular == pytest.approx([0.0, 400.0, 0.0])


def test_a_bound_can_be_set(rotor: World):
    rotor["rotor"].change_dynamics(0, max_joint_velocity=50.0)
    rotor.step(1000)
    assert rotor["rotor"].joints["spin"].velocity == 50.0
    rotor["rotor"].change_dynamics(0, max_joint_velocity=inf)
    rotor.step(1000)
    assert rotor["rotor"].joints["spin"].velocity > 250.0


def test_the_drop_in_holds_them_as_pybullet_does(tmp_path: Path):
    path = tmp_path / "rotor.xml"
    path.write_text(ROTOR)
    client = p.connect(p.DIRECT)
    body = p.createMultiBody(1.0, p.createCollisionShape(p.GEOM_SPHERE, radius=0.02))
    p.resetBaseVelocity(body, (700.0, 0.0, 0.0))
    p.stepSimulation()
    assert p.getBaseVelocity(body)[0][0] == 100.0
    p.disconnect(client)
