"""Robots that the tests of controllers move."""

from __future__ import annotations

from pathlib import Path

import pybullet_data
from carom import Body, World
from carom.examples import robot_file

DATA = Path(pybullet_data.getDataPath())
SWINGING_POLE = robot_file("swinging_pole.urdf")
READY = (0.0, -0.4, 0.0, -2.0, 0.0, 1.7, 0.8, 0.02, 0.02)
HAND = 11


def panda(time_step: float = 1e-3, gravity: float = -9.81) -> tuple[World, Body]:
    """A Panda without damping, motors and coupling of its fingers, in a pose away from singularities."""
    world = World(time_step)
    world.gravity = (0.0, 0.0, gravity)
    robot = world.load_urdf(DATA / "franka_panda" / "panda.urdf", fixed_base=True)
    for coupling in world.user_constraints.all:
        world.remove_constraint(coupling)
    robot.change_dynamics(-1, linear_damping=0.0, angular_damping=0.0, joint_damping=0.0)
    for joint in robot.joints.movable:
        joint.damping = 0.0
        joint.free()
    robot.joints.reset(READY)
    return world, robot


def swinging_pole(time_step: float, angle: float = 0.0, contact: str | None = None) -> tuple[World, Body]:
    """A cart with a pole that hangs at angle 0, without motors."""
    world = World(time_step) if contact is None else World(time_step, contact=contact)
    world.gravity = (0.0, 0.0, -9.81)
    robot = world.load_urdf(SWINGING_POLE, fixed_base=True)
    robot.joints.free()
    robot.joints["swing"].reset(angle)
    return world, robot
