"""Stable proportional-derivative (PD) control in Python, with the classes of PyBullet's module.

The method is that of Tan, Liu and Turk (Stable Proportional-Derivative Controllers, 2011). The velocity
error is the one expected after the next step: the equations of motion are solved together with the
controller's own damping, so that high gains stay stable with long time steps. The position error is the
present one, as in PyBullet; the paper uses the expected one. `setJointMotorControlMultiDofArray` with
`STABLE_PD_CONTROL` is faster.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

_BASE_POSITIONS, _BASE_RATES = 7, 6
# Length of a quaternion, and of an angular velocity padded with a zero.
_ROTATION = 4


class PDControllerStable:
    """Stable PD control of joints with one dof.

    Lists have a value for each joint. If the base is free, seven positions and six velocities of the base
    come first; the base is assumed to be at rest and to have the desired orientation.
    """

    def __init__(self, pb: Any) -> None:
        """Makes a controller; `pb` is the module `pybullet` or a `BulletClient`."""
        self._pb = pb

    def computePD(
        self,
        bodyUniqueId: int,
        jointIndices: Sequence[int],
        desiredPositions: Sequence[float],
        desiredVelocities: Sequence[float],
        kps: Sequence[float],
        kds: Sequence[float],
        maxForces: Sequence[float],
        timeStep: float,
    ) -> np.ndarray:
        """Torques [N m] that drive the joints to the desired positions.

        Args:
            bodyUniqueId: The body.
            jointIndices: All its joints.
            desiredPositions: Desired positions [rad or m].
            desiredVelocities: Desired velocities [rad/s or m/s].
            kps: Proportional gains: torque per position error.
            kds: Derivative gains: torque per velocity error.
            maxForces: Maximum torques [N m].
            timeStep: Time step of the simulation [s].
        """
        states = self._pb.getJointStates(bodyUniqueId, jointIndices)
        positions = [state[0] for state in states]
        rates = [state[1] for state in states]
        errors = np.subtract(desiredPositions[-len(states) :], positions).tolist()
        if self._pb.getDynamicsInfo(bodyUniqueId, -1)[0] > 0.0:
            origin, turn = self._pb.getBasePositionAndOrientation(bodyUniqueId)
            positions = [*origin, *turn, *positions]
            rates = [0.0] * _BASE_RATES + rates
            errors = [*np.subtract(desiredPositions[:3], origin).tolist(), 0.0, 0.0, 0.0, *errors]
        gains = _Gains(kps, kds, maxForces)
        masses = self._pb.calculateMassMatrix(bodyUniqueId, positions)
        bias = self._pb.calculateInverseDynamics(bodyUniqueId, positions, rates, [0.0] * len(rates))
        return _torques(gains, masses, bias, errors, np.subtract(desiredVelocities, rates), timeStep)


class PDControllerStableMultiDof:
    """Stable PD control of joints with any number of dofs, on a free base.

    Positions, velocities, gains and torques have the layout of PyBullet's flags=1: seven numbers for the
    base, then four for each spherical joint (the fourth velocity is unused), and one for each other joint.
    As in PyBullet the orientation of the base has no position gain; only its angular velocity is damped.
    """

    def __init__(self, pb: Any) -> None:
        """Makes a controller; `pb` is the module `pybullet` or a `BulletClient`."""
        self._pb = pb

    def computeAngVel(
        self, ornStart: Sequence[float], ornEnd: Sequence[float], deltaTime: float, bullet_client: Any
    ) -> list[float]:
        """Angular velocity [rad/s], in world axes, that rotates one orientation to another in a time [s]."""
        turn = bullet_client.getDifferenceQuaternion(ornStart, ornEnd)
        axis, angle = bullet_client.getAxisAngleFromQuaternion(turn)
        return [component * angle / deltaTime for component in axis]

    def quatMul(self, q1: Sequence[float], q2: Sequence[float]) -> list[float]:
        """The product of two quaternions: the rotation q2 followed by q1."""
        x1, y1, z1, w1 = q1
        x2, y2, z2, w2 = q2
        return [
            w1 * x2 + x1 * w2 + y1 * z2 - z1 * y2,
            w1 * y2 + y1 * w2 + z1 * x2 - x1 * z2,
            w1 * z2 + z1 * w2 + x1 * y2 - y1 * x2,
            w1 * w2 - x1 * x2 - y1 * y2 - z1 * z2,
        ]

    def computeAngVelRel(
        self, ornStart: Sequence[float], ornEnd: Sequence[float], deltaTime: float, bullet_client: Any
    ) -> list[float]:
        """Like `computeAngVel`, but in the axes of the first orientation."""
        back = [-ornStart[0], -ornStart[1], -ornStart[2], ornStart[3]]
        turn = self.quatMul(back, ornEnd)
        axis, angle = bullet_client.getAxisAngleFromQuaternion(turn)
        return [component * angle / deltaTime for component in axis]

    def computePD(
        self,
        bodyUniqueId: int,
        jointIndices: Sequence[int],
        desiredPositions: Sequence[float],
        desiredVelocities: Sequence[float],
        kps: Sequence[float],
        kds: Sequence[float],
        maxForces: Sequence[float],
        timeStep: float,
    ) -> np.ndarray:
        """Torques [N m] that drive base and joints to the desired positions; those of the base come first.

        Args:
            bodyUniqueId: The body.
            jointIndices: All its joints that move.
            desiredPositions: Desired positions.
            desiredVelocities: Desired velocities.
            kps: Proportional gains: torque per position error.
            kds: Derivative gains: torque per velocity error.
            maxForces: Maximum torques [N m].
            timeStep: Time step of the simulation [s].
        """
        bullet = self._pb
        origin, turn = bullet.getBasePositionAndOrientation(bodyUniqueId)
        linear, angular = bullet.getBaseVelocity(bodyUniqueId)
        positions = [*origin, *turn]
        rates = [*linear, *angular, 0.0]
        errors = [
            *(aim - now for aim, now in zip(desiredPositions[:3], origin, strict=True)),
            *(0.0,) * (_BASE_POSITIONS - 3),
        ]
        for position, rate, _, _ in bullet.getJointStatesMultiDof(bodyUniqueId, jointIndices):
            aim = desiredPositions[len(positions) : len(positions) + len(position)]
            if len(position) == 1:
                errors.append(aim[0] - position[0])
            elif len(position) == _ROTATION:
                errors += [*self.computeAngVelRel(position, aim, 1.0, bullet), 0.0]
                rate = (*rate, 0.0)
            positions += position
            rates += rate[: len(position)]
        gains = _Gains(kps, kds, maxForces)
        masses = bullet.calculateMassMatrix(bodyUniqueId, positions, flags=1)
        still = [0.0] * len(rates)
        bias = bullet.calculateInverseDynamics(bodyUniqueId, positions, rates, still, flags=1)
        return _torques(gains, masses, bias, errors, np.subtract(desiredVelocities, rates), timeStep)


@dataclass(frozen=True, slots=True)
class _Gains:
    """Proportional gains, derivative gains and maximum torques, each with a value per dof."""

    kp: Sequence[float]
    kd: Sequence[float]
    most: Sequence[float]


def _torques(
    gains: _Gains, masses: Any, bias: Any, errors: Sequence[float], rate_errors: np.ndarray, time_step: float
) -> np.ndarray:
    """Torques for position and velocity errors, given the mass matrix and the bias forces."""
    damping = np.asarray(gains.kd, dtype=float)
    wanted = np.multiply(gains.kp, errors) + damping * rate_errors
    acceleration = np.linalg.solve(
        np.asarray(masses) + np.diag(damping * time_step), wanted - np.asarray(bias)
    )
    most = np.asarray(gains.most)
    return np.clip(wanted - damping * acceleration * time_step, -most, most)
