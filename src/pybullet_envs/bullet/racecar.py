"""A racing car whose motors drive both axles through differentials."""

from __future__ import annotations

import os
from collections.abc import Sequence
from typing import Any

import pybullet
import pybullet_data

# Gear constraints: two links, the gear ratio, and the link that rotations are relative to, if any.
_GEARS = (
    (9, 11, 1, None),
    (10, 13, -1, None),
    (9, 13, -1, None),
    (16, 18, 1, None),
    (16, 19, -1, None),
    (17, 19, -1, None),
    (1, 18, -1, 15),
    (3, 19, -1, 15),
)
_GEAR_FORCE = 10000


class Racecar:
    """The car, in an existing world.

    Attributes:
        racecarUniqueId: Id of the car.
        steeringLinks: Joints that steer.
        motorizedwheels: Joints that drive.
        speedMultiplier: Speed of the motors at full throttle [rad/s].
        steeringMultiplier: Angle of the wheels at full lock [rad].
        maxForce: Maximum torque of each motor [N m].
    """

    def __init__(
        self, bullet_client: Any = pybullet, urdfRootPath: str | None = None, timeStep: float = 0.01
    ) -> None:
        """Loads the car.

        Args:
            bullet_client: The world; by default the first connection.
            urdfRootPath: Folder of the files; by default that of `pybullet_data`.
            timeStep: No effect; kept as an attribute [s].
        """
        self._p = bullet_client
        self.urdfRootPath = urdfRootPath or pybullet_data.getDataPath()
        self.timeStep = timeStep
        self.steeringLinks = [0, 2]
        self.motorizedwheels = [8, 15]
        self.nMotors = 2
        self.maxForce = 20
        self.speedMultiplier = 20.0
        self.steeringMultiplier = 0.5
        self.reset()

    def reset(self) -> None:
        """Loads the car, switches its motors off and adds its gears."""
        bullet = self._p
        file = os.path.join(self.urdfRootPath, "racecar/racecar_differential.urdf")
        car = self.racecarUniqueId = bullet.loadURDF(file, [0, 0, 0.2])
        for joint in range(bullet.getNumJoints(car)):
            bullet.setJointMotorControl2(car, joint, pybullet.VELOCITY_CONTROL, targetVelocity=0, force=0)
        for first, second, ratio, against in _GEARS:
            gear = bullet.createConstraint(
                car, first, car, second, pybullet.JOINT_GEAR, [0, 1, 0], [0, 0, 0], [0, 0, 0]
            )
            aux = {} if against is None else {"gearAuxLink": against}
            bullet.changeConstraint(gear, gearRatio=ratio, maxForce=_GEAR_FORCE, **aux)

    def getActionDimension(self) -> int:
        """Size of an action."""
        return self.nMotors

    def getObservationDimension(self) -> int:
        """Size of the result of `getObservation`."""
        return len(self.getObservation())

    def getObservation(self) -> list[float]:
        """Position [m] and orientation (x, y, z, w) of the car."""
        position, orientation = self._p.getBasePositionAndOrientation(self.racecarUniqueId)
        return [*position, *orientation]

    def applyAction(self, motorCommands: Sequence[float]) -> None:
        """Sets throttle and steering.

        Args:
            motorCommands: Fractions of the maximum speed and of the maximum steering angle.
        """
        throttle, lock = motorCommands
        for joint in self.motorizedwheels:
            self._p.setJointMotorControl2(
                self.racecarUniqueId,
                joint,
                pybullet.VELOCITY_CONTROL,
                targetVelocity=throttle * self.speedMultiplier,
                force=self.maxForce,
            )
        for joint in self.steeringLinks:
            self._p.setJointMotorControl2(
                self.racecarUniqueId,
                joint,
                pybullet.POSITION_CONTROL,
                targetPosition=lock * self.steeringMultiplier,
            )
