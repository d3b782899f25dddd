"""Shared code of `panda_sim` and `panda_sim_grasp`: a Panda arm over a tray, with y as the up axis."""

from __future__ import annotations

from collections.abc import Sequence
from math import pi
from typing import Any

import numpy as np

from pybullet_robots._loading import load_all, put_in_pose

END_EFFECTOR = 11
ARM_JOINTS = 7
FINGERS = (9, 10)
FIRST_POSE = [0.98, 0.458, 0.31, -2.24, -0.30, 2.66, 2.32, 0.02, 0.02]
LOWER, UPPER, RANGES = ([bound] * ARM_JOINTS for bound in (-7, 7, 7))
_FORCE = 5 * 240.0

_BRICKS = ((0.1, 0.3, -0.5), (-0.1, 0.3, -0.5), (0.1, 0.3, -0.7))
_BALLS = ((0.0, 0.3, -0.6), (0.0, 0.3, -0.5), (0.0, 0.3, -0.7))
_UPRIGHT = [-0.707107, 0.0, 0.0, 0.707107]


class PandaOverTray:
    """An arm, a tray, three bricks and three balls.

    Attributes:
        bullet_client: `pybullet` or a `BulletClient`.
        offset: Position of the arm's base [m].
        legos: Ids of the bricks.
        sphereId: Id of the first ball.
        panda: Id of the arm.
        t: Time along the path of the hand [s].
    """

    def __init__(self, bullet_client: Any, offset: Sequence[float]) -> None:
        """Loads arm, tray, bricks and balls.

        Args:
            bullet_client: `pybullet` or a `BulletClient`, with gravity, time step and search path set.
            offset: Position of the arm's base [m].
        """
        self.bullet_client = bullet_client
        self.offset = np.array(offset)
        flags = bullet_client.URDF_ENABLE_CACHED_GRAPHICS_SHAPES
        tray = self.offset + np.array([0.0, 0.0, -0.6])
        bullet_client.loadURDF("tray/traybox.urdf", tray, [-0.5, -0.5, -0.5, 0.5], flags=flags)
        self.legos = load_all(bullet_client, "lego/lego.urdf", _BRICKS, self.offset)
        self.sphereId = load_all(bullet_client, "sphere_small.urdf", _BALLS, self.offset)[0]
        self.panda = bullet_client.loadURDF(
            "franka_panda/panda.urdf", self.offset, _UPRIGHT, useFixedBase=True, flags=flags
        )
        put_in_pose(bullet_client, self.panda, FIRST_POSE)
        self.t = 0.0

    def reset(self) -> None:
        """Does nothing; scripts load the world again instead."""

    def _move_hand(self, position: Sequence[float], iterations: int) -> None:
        """Sets the motors of the arm so that the hand moves to a position [m] and points down."""
        client = self.bullet_client
        down = client.getQuaternionFromEuler([pi / 2, 0.0, 0.0])
        angles = client.calculateInverseKinematics(
            self.panda, END_EFFECTOR, position, down, LOWER, UPPER, RANGES, FIRST_POSE,
            maxNumIterations=iterations,
        )  # fmt: skip
        for joint in range(ARM_JOINTS):
            client.setJointMotorControl2(
                self.panda, joint, client.POSITION_CONTROL, angles[joint], force=_FORCE
            )
