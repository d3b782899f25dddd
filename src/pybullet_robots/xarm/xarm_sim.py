"""An xArm whose hand moves along a circle over a tray."""

from __future__ import annotations

from collections.abc import Sequence
from math import cos, sin
from typing import Any

import numpy as np

from pybullet_robots._loading import load_all, put_in_pose

useNullSpace = 0
useDynamics = 1
useIKFast = 0
ikSolver = 0
xarmEndEffectorIndex = 6
xarmNumDofs = 6
ll, ul, jr = ([bound] * xarmNumDofs for bound in (-17, 17, 17))
jointPositions = rp = jointPoses = [0] * xarmNumDofs

_BRICKS = ((0.3, 0.1, 0.3), (0.3, -0.1, 0.3), (0.5, 0.1, 0.3))
_BALLS = ((0.4, 0.0, 0.3), (0.3, 0.0, 0.3), (0.5, 0.0, 0.3))
_DOWN = [1, 0, 0, 0]
_FORCE = 5 * 240.0


class XArm6Sim:
    """An xArm; each `step` advances the path of its hand by 1/60 s.

    Attributes:
        bullet_client: `pybullet` or a `BulletClient`.
        offset: Position of the arm's base [m].
        xarm: Id of the arm.
        jointPoses: Last target positions of the joints [rad].
        t: Time along the path of the hand [s].
    """

    def __init__(self, bullet_client: Any, offset: Sequence[float]) -> None:
        """Loads the arm, a tray, three bricks and three balls.

        Args:
            bullet_client: `pybullet` or a `BulletClient`, with gravity, time step and search path set.
            offset: Position of the arm's base [m].
        """
        self.bullet_client = bullet_client
        self.offset = np.array(offset)
        flags = bullet_client.URDF_ENABLE_CACHED_GRAPHICS_SHAPES
        bullet_client.loadURDF("tray/traybox.urdf", self.offset + np.array([0.4, 0.0, 0.0]), flags=flags)
        load_all(bullet_client, "lego/lego.urdf", _BRICKS, self.offset)
        load_all(bullet_client, "sphere_small.urdf", _BALLS, self.offset)
        self.xarm = bullet_client.loadURDF(
            "xarm/xarm6_robot.urdf", self.offset, useFixedBase=True, flags=flags
        )
        put_in_pose(bullet_client, self.xarm, jointPositions)
        self.jointPoses: Sequence[float] = [0.0] * xarmNumDofs
        self.t = 0.0

    def reset(self) -> None:
        """Does nothing; scripts load the world again instead."""

    def step(self) -> None:
        """Sets the motors and draws a line from target to hand; the script calls `stepSimulation`."""
        client = self.bullet_client
        x, y, z = self.offset
        place = [x + 0.407 + 0.2 * sin(1.5 * self.t), y + 0.2 * cos(1.5 * self.t), z + 0.12]
        self.t += 1.0 / 60.0
        self.jointPoses = client.calculateInverseKinematics(
            self.xarm, xarmEndEffectorIndex, place, _DOWN, maxNumIterations=50
        )
        for joint, angle in enumerate(self.jointPoses[:xarmNumDofs], start=1):
            client.setJointMotorControl2(self.xarm, joint, client.POSITION_CONTROL, angle, force=_FORCE)
        hand = client.getLinkState(self.xarm, xarmEndEffectorIndex, computeForwardKinematics=True)[4]
        client.addUserDebugLine(place, hand, [1, 0, 0], lifeTime=100)
