"""A KUKA arm with a gripper above a tray, controlled by target positions of its wrist."""

from __future__ import annotations

import os
from collections.abc import Sequence
from math import pi
from typing import Any

import pybullet
import pybullet_data

WRIST, GRIPPER = 6, 7
LEFT_FINGER, LEFT_TIP, RIGHT_FINGER, RIGHT_TIP = 8, 10, 11, 13
# Bounds of the target position of the wrist [m].
REACH_X, REACH_Y = (0.5, 0.65), (-0.17, 0.22)
_DOWN = (0.0, -pi, 0.0)
_STANCE = (
    *(0.006418, 0.413184, -0.011401, -1.589317, 0.005379, 1.137684, -0.006539),
    *(0.000048, -0.299912, 0.0, -0.000043, 0.29996, 0.0, -0.0002),
)


class Kuka:
    """The arm, its gripper and the tray, in an existing world.

    Attributes:
        kukaUid: Id of the arm.
        trayUid: Id of the tray.
        endEffectorPos: Target position of the wrist [m].
        endEffectorAngle: Target angle of the gripper [rad].
        motorIndices: Indices of the joints that move.
        motorNames: Names of these joints: `str` of the bytes.
        useInverseKinematics: Whether actions are motions of the wrist; otherwise, joint targets.
        useNullSpace: 1 for inverse kinematics near `rp`, within `ll` and `ul`.
        useOrientation: Whether inverse kinematics keeps the gripper pointing down.
        useSimulation: Whether motors move the joints; otherwise, joints are set to the targets at once.
    """

    def __init__(
        self,
        urdfRootPath: str | None = None,
        timeStep: float = 0.01,
        bullet_client: Any = pybullet,
    ) -> None:
        """Loads arm and tray.

        Args:
            urdfRootPath: Folder of the files; by default that of `pybullet_data`.
            timeStep: No effect; kept as an attribute [s].
            bullet_client: The world; by default the first connection.
        """
        self._p = bullet_client
        self.urdfRootPath = pybullet_data.getDataPath() if urdfRootPath is None else urdfRootPath
        self.timeStep = timeStep
        self.maxVelocity = 0.35
        self.maxForce = 200.0
        self.fingerAForce = 2
        self.fingerBForce = 2.5
        self.fingerTipForce = 2
        self.useInverseKinematics = 1
        self.useSimulation = 1
        self.useNullSpace = 21
        self.useOrientation = 1
        self.kukaEndEffectorIndex = WRIST
        self.kukaGripperIndex = GRIPPER
        self.ll = [-0.967, -2, -2.96, 0.19, -2.96, -2.09, -3.05]
        self.ul = [0.967, 2, 2.96, 2.29, 2.96, 2.09, 3.05]
        self.jr = [5.8, 4, 5.8, 4, 5.8, 4, 6]
        self.rp = [0, 0, 0, 0.5 * pi, 0, -pi * 0.5 * 0.66, 0]
        self.jd = [0.00001] * len(_STANCE)
        self.reset()

    def reset(self) -> None:
        """Loads arm and tray, and moves the arm to its initial pose."""
        bullet = self._p
        (self.kukaUid, *_) = bullet.loadSDF(
            os.path.join(self.urdfRootPath, "kuka_iiwa/kuka_with_gripper2.sdf")
        )
        bullet.resetBasePositionAndOrientation(self.kukaUid, [-0.1, 0.0, 0.07], [0.0, 0.0, 0.0, 1.0])
        self.jointPositions = list(_STANCE)
        self.numJoints = bullet.getNumJoints(self.kukaUid)
        for joint, position in zip(range(self.numJoints), self.jointPositions, strict=True):
            bullet.resetJointState(self.kukaUid, joint, position)
            self._drive(joint, position, self.maxForce)
        self.trayUid = bullet.loadURDF(
            os.path.join(self.urdfRootPath, "tray/tray.urdf"), [0.64, 0.075, -0.19], [0.0, 0.0, 1.0, 0.0]
        )
        self.endEffectorPos = [0.537, 0.0, 0.5]
        self.endEffectorAngle = 0.0
        infos = [bullet.getJointInfo(self.kukaUid, joint) for joint in range(self.numJoints)]
        self.motorIndices = [info[0] for info in infos if info[3] > -1]
        self.motorNames = [str(info[1]) for info in infos if info[3] > -1]

    def getActionDimension(self) -> int:
        """As in PyBullet: with inverse kinematics the number of moving joints, otherwise 6."""
        return len(self.motorIndices) if self.useInverseKinematics else 6

    def getObservationDimension(self) -> int:
        """Size of the result of `getObservation`."""
        return len(self.getObservation())

    def getObservation(self) -> list[float]:
        """Position [m], roll, pitch and yaw [rad] of the gripper."""
        position, orientation = self._p.getLinkState(self.kukaUid, self.kukaGripperIndex)[:2]
        return [*position, *self._p.getEulerFromQuaternion(orientation)]

    def applyAction(self, motorCommands: Sequence[float]) -> None:
        """Sets the targets of the motors.

        Args:
            motorCommands: Motion of the wrist along x, y and z [m], rotation of the gripper and opening of
                each finger [rad]. Without inverse kinematics, targets of the joints.
        """
        if not self.useInverseKinematics:
            for joint, target in zip(self.motorIndices, motorCommands, strict=False):
                self._drive(joint, target, self.maxForce)
            return
        dx, dy, dz, turn, finger = motorCommands[:5]
        x, y, z = self.endEffectorPos
        # In place, because scripts hold a reference to the list.
        self.endEffectorPos[:] = [
            min(max(x + dx, REACH_X[0]), REACH_X[1]),
            min(max(y + dy, REACH_Y[0]), REACH_Y[1]),
            z + dz,
        ]
        self.endEffectorAngle += turn
        self._go(self.joints_for(self.endEffectorPos))
        self._drive(self.kukaGripperIndex, self.endEffectorAngle, self.maxForce)
        self._drive(LEFT_FINGER, -finger, self.fingerAForce)
        self._drive(RIGHT_FINGER, finger, self.fingerBForce)
        self._drive(LEFT_TIP, 0.0, self.fingerTipForce)
        self._drive(RIGHT_TIP, 0.0, self.fingerTipForce)

    def joints_for(self, place: Sequence[float]) -> tuple[float, ...]:
        """Joint positions that bring the wrist to a position [m], by inverse kinematics."""
        options: dict[str, Any] = {}
        if self.useOrientation:
            options["targetOrientation"] = self._p.getQuaternionFromEuler(_DOWN)
        if self.useNullSpace == 1:
            options |= {
                "lowerLimits": self.ll,
                "upperLimits": self.ul,
                "jointRanges": self.jr,
                "restPoses": self.rp,
            }
        elif self.useOrientation:
            options["jointDamping"] = self.jd
        return self._p.calculateInverseKinematics(self.kukaUid, self.kukaEndEffectorIndex, place, **options)

    def _go(self, positions: Sequence[float]) -> None:
        if not self.useSimulation:
            for joint, position in zip(range(self.numJoints), positions, strict=False):
                self._p.resetJointState(self.kukaUid, joint, position)
            return
        for joint in range(self.kukaEndEffectorIndex + 1):
            self._p.setJointMotorControl2(
                self.kukaUid,
                joint,
                pybullet.POSITION_CONTROL,
                targetPosition=positions[joint],
                targetVelocity=0,
                force=self.maxForce,
                maxVelocity=self.maxVelocity,
                positionGain=0.3,
                velocityGain=1,
            )

    def _drive(self, joint: int, target: float, force: float) -> None:
        self._p.setJointMotorControl2(
            self.kukaUid, joint, pybullet.POSITION_CONTROL, targetPosition=target, force=force
        )
