"""Motors, limits and constraints in the same equations as rigid contacts."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from tests.converged.rigid_worlds import rigid_world

import pybullet_data
from carom import World
from carom.scene.body import Body

DATA = Path(pybullet_data.getDataPath())
_FINGER = """
  <link name="{name}"><inertial><mass value="0.1"/><inertia ixx="1e-4" iyy="1e-4" izz="1e-4" ixy="0" ixz="0"
    iyz="0"/></inertial><collision><geometry><box size="0.02 0.04 0.06"/></geometry></collision></link>
  <joint name="to_{name}" type="prismatic"><parent link="palm"/><child link="{name}"/>
    <origin xyz="{x} 0 0"/><axis xyz="{axis} 0 0"/>
    <limit lower="0" upper="0.1" effort="100" velocity="1"/></joint>
"""
_GRIPPER = (
    '<robot name="gripper"><link name="palm"><inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" '
    'ixy="0" ixz="0" iyz="0"/></inertial></link>'
    + _FINGER.format(name="left", x=-0.1, axis=1)
    + _FINGER.format(name="right", x=0.1, axis=-1)
    + "</robot>"
)


def _pinched(world: World, folder: Path, size: float) -> tuple[Body, Body]:
    """A gripper of two fingers, and a cube of that size [m] between them."""
    path = folder / "gripper.urdf"
    path.write_text(_GRIPPER)
    gripper = world.load(path, (0.0, 0.0, 0.5), fixed_base=True)["gripper"]
    cube = world.add_box((size / 2,) * 3, (0.0, 0.0, 0.5), mass=0.2, friction=0.8)
    for finger in ("left", "right"):
        gripper.change_dynamics(gripper.links[finger].index, lateral_friction=1.0)
    for joint in ("to_left", "to_right"):
        gripper.joints[joint].position = 0.09 - size / 2
        gripper.joints[joint].set_velocity_target(0.1, max_force=10.0)
    return gripper, cube


@pytest.mark.parametrize(
    ("size", "seconds"),
    [
        (0.05, 2),
        (0.004, 2),
        *(pytest.param(size, 60, marks=pytest.mark.long) for size in (0.05, 0.02, 0.01, 0.004)),
    ],
)
def test_a_gripper_holds_without_slip(tmp_path: Path, size: float, seconds: int) -> None:
    world = rigid_world()
    _, cube = _pinched(world, tmp_path, size)
    world.step(60)
    start = np.array(cube.pose.position)
    assert start[2] == pytest.approx(0.5, abs=2e-3)
    world.step(240 * seconds)
    assert np.linalg.norm(cube.pose.position - start) < 1e-5


def test_a_robot_under_motors_moves_as_with_sweeps() -> None:
    ends = []
    for contact in ("bullet", "rigid"):
        world = World(gravity=(0.0, 0.0, -9.81), contact=contact)
        panda = world.load(DATA / "franka_panda" / "panda.urdf", fixed_base=True)["panda"]
        for joint, target in zip(range(7), (0.0, -0.4, 0.0, -2.2, 0.0, 1.9, 0.8), strict=True):
            panda.joints[joint].set_position_target(target)
        world.step(480)
        ends.append([panda.joints[joint].position for joint in range(7)])
    assert ends[1] == pytest.approx(ends[0], abs=1e-4)


def test_a_walker_stands() -> None:
    world = rigid_world()
    world.add_plane()
    robot = world.load(DATA / "laikago" / "laikago_toes.urdf", (0.0, 0.0, 0.48), (0.0, 0.5, 0.5, 0.0))[0]
    for joint in robot.joints.movable:
        joint.set_position_target(joint.position, max_force=100.0)
    world.step(480)
    start = np.array(robot.pose.position)
    world.step(240)
    assert 0.3 < start[2] < 0.5
    assert np.linalg.norm(robot.pose.position - start) < 1e-4
