"""Isotropic friction: what a body does on a plane does not depend on its heading."""

from __future__ import annotations

from collections.abc import Iterator
from math import cos, sin
from pathlib import Path

import numpy as np
import pytest

import carom
import pybullet as p
from carom.description.geometry import Box, Plane, Sphere
from carom.description.link import Collision, ContactParameters
from carom.model.body_spec import BodySpec, LinkSpec

SHAPES = {
    "ball": (Sphere(0.1), (0.004, 0.004, 0.004), 0.1),
    "brick": (Box((0.15, 0.1, 0.05)), (0.0042, 0.0083, 0.0108), 0.05),
}
HEADINGS = (0.0, 0.4, 0.8, 1.2, 1.571, 2.2, 2.9)
CAR = """
<robot name="car">
  <link name="body">
    <inertial><mass value="20"/><inertia ixx="0.3" iyy="0.6" izz="0.8" ixy="0" ixz="0" iyz="0"/></inertial>
  </link>
  {wheels}
</robot>
"""
WHEEL = """
  <link name="{name}">
    <inertial><mass value="1"/>
      <inertia ixx="0.004" iyy="0.006" izz="0.004" ixy="0" ixz="0" iyz="0"/></inertial>
    <collision><geometry>{shape}</geometry></collision>
    <contact><lateral_friction value="{friction}"/></contact>
  </link>
  <joint name="{name}_joint" type="continuous">
    <parent link="body"/><child link="{name}"/><origin xyz="{x} {y} 0"/><axis xyz="0 1 0"/>
  </joint>
"""


@pytest.fixture(autouse=True)
def _connection() -> Iterator[None]:
    p.connect(p.DIRECT)
    yield
    p.disconnect()


def turning_rate(tmp_path: Path, heading: float, bound: int, shape: str = '<sphere radius="0.1"/>') -> float:
    """Rate at which a four-wheeler turns on the spot, its left wheels turning backwards [rad/s]."""
    p.resetSimulation()
    p.setGravity(0, 0, -9.8)
    p.setPhysicsEngineParameter(enableConeFriction=bound)
    places = [(x, y) for x in (-0.25, 0.25) for y in (-0.2, 0.2)]
    wheels = [
        WHEEL.format(name=f"w{i}", x=x, y=y, shape=shape, friction=0.8) for i, (x, y) in enumerate(places)
    ]
    file = tmp_path / "car.urdf"
    file.write_text(CAR.format(wheels="".join(wheels)))
    ground = p.createMultiBody(0, p.createCollisionShape(p.GEOM_PLANE))
    p.changeDynamics(ground, -1, lateralFriction=1)
    car = p.loadURDF(str(file), [0, 0, 0.1], p.getQuaternionFromEuler([0, 0, heading]))
    for wheel, (_, y) in enumerate(places):
        p.setJointMotorControl2(car, wheel, p.VELOCITY_CONTROL, targetVelocity=5 if y < 0 else -5, force=50)
    for _ in range(120):
        p.stepSimulation()
    start = p.getBasePositionAndOrientation(car)[1]
    for _ in range(60):
        p.stepSimulation()
    turned = p.getDifferenceQuaternion(start, p.getBasePositionAndOrientation(car)[1])
    return p.getEulerFromQuaternion(turned)[2] / 0.25


@pytest.mark.parametrize("shape", ['<sphere radius="0.1"/>', '<cylinder radius="0.1" length="0.05"/>'])
def test_a_vehicle_with_skid_steering_turns_at_one_rate_at_all_headings(tmp_path: Path, shape: str) -> None:
    rates = [turning_rate(tmp_path, heading, 2, shape) for heading in HEADINGS]
    assert rates[0] > 0.3
    np.testing.assert_allclose(rates, rates[0], rtol=2e-3)


def test_by_default_its_rate_depends_on_the_heading_as_in_pybullet(tmp_path: Path) -> None:
    """The rates are those that PyBullet 3.2.7 gives."""
    rates = [turning_rate(tmp_path, heading, 1) for heading in HEADINGS]
    np.testing.assert_allclose(rates, [0.2253, 0.8976, 0.5131, 0.2531, 0.2257, 0.6544, 0.1836], atol=2e-4)


def path(kind: str, heading: float, rolling: float = 0.0) -> np.ndarray:
    """Places, angular and linear velocities of a body thrown over the ground, seen along its heading."""
    world = carom.World()
    world.gravity = (0, 0, -9.8)
    world.parameters.isotropic_friction = True
    turn = np.array([[cos(heading), -sin(heading), 0], [sin(heading), cos(heading), 0], [0, 0, 1]])
    shape, inertia, height = SHAPES[kind]
    plane = LinkSpec(
        "base", collisions=(Collision(Plane()),), contact=ContactParameters(lateral_friction=1.0)
    )
    world.load(BodySpec("ground", plane, fixed_base=True))
    contact = ContactParameters(lateral_friction=0.4, rolling_friction=rolling)
    link = LinkSpec("base", mass=1.0, inertia=inertia, collisions=(Collision(shape),), contact=contact)
    turned = (0, 0, sin(heading / 2), cos(heading / 2))
    thrown = world.load(BodySpec(kind, link), (0, 0, height), turned)
    spin = (0.0, 0.0, 8.0) if kind == "brick" else (12.0, 3.0, 2.0)
    thrown.change_dynamics(-1, linear_damping=0.0, angular_damping=0.0)
    thrown.set_base_velocity((turn @ (1.5, 0, 0)).tolist(), (turn @ spin).tolist())
    track = []
    for _ in range(100):
        world.step()
        place = world.position[thrown.first_position :][:3]
        velocity = world.velocity[thrown.first_velocity :][:6]
        track.append([*(turn.T @ place), *(turn.T @ velocity[:3]), *(turn.T @ velocity[3:])])
    return np.array(track)


@pytest.mark.parametrize(("kind", "rolling"), [("ball", 0.0), ("ball", 0.02), ("brick", 0.0)])
def test_the_path_of_a_sliding_body_turns_with_its_heading(kind: str, rolling: float) -> None:
    first = path(kind, 0.0, rolling)
    assert np.abs(first[-1, :2]).max() > 0.2
    for heading in (0.3, 0.9, 2.0):
        np.testing.assert_allclose(path(kind, heading, rolling), first, rtol=0, atol=2e-3)


def test_friction_of_a_sliding_ball_is_opposite_to_the_velocity_of_its_lowest_point() -> None:
    track = path("ball", 0.7)
    push = (track[13, 6:8] - track[12, 6:8]) * 240.0
    sliding = track[12, 6:8] + np.cross(track[12, 3:6], (0, 0, -0.1))[:2]
    assert np.linalg.norm(push) == pytest.approx(0.4 * 9.8, rel=1e-3)
    np.testing.assert_allclose(push / np.linalg.norm(push), -sliding / np.linalg.norm(sliding), atol=1e-3)


@pytest.mark.parametrize(("friction", "moves"), [(0.5, False), (0.35, True)])
def test_a_brick_sticks_up_to_the_angle_of_friction(friction: float, moves: bool) -> None:
    p.setPhysicsEngineParameter(enableConeFriction=2)
    slope = 0.4
    p.setGravity(9.8 * sin(slope) * cos(0.6), 9.8 * sin(slope) * sin(0.6), -9.8 * cos(slope))
    ground = p.createMultiBody(0, p.createCollisionShape(p.GEOM_PLANE))
    p.changeDynamics(ground, -1, lateralFriction=1)
    shape = p.createCollisionShape(p.GEOM_BOX, halfExtents=[0.15, 0.1, 0.05])
    brick = p.createMultiBody(1, shape, basePosition=[0, 0, 0.05])
    p.changeDynamics(brick, -1, lateralFriction=friction)
    for _ in range(240):
        p.stepSimulation()
    (x, y, _), _ = p.getBasePositionAndOrientation(brick)
    if moves:
        # tan 0.4 is 0.423.
        way = 0.5 * 9.8 * (sin(slope) - friction * cos(slope))
        assert (x, y) == pytest.approx((way * cos(0.6), way * sin(0.6)), rel=0.02)
    else:
        assert abs(x) + abs(y) < 3e-4
