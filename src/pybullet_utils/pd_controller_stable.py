"""Stable proportional-derivative control in Python, as scripts of PyBullet do it.

After the controller of Tan, Liu and Turk (Stable Proportional-Derivative Controllers, 2011). The error of
velocity is the one expected after the next step, for which the equations of motion are solved together with
the controller's own damping; high gains then stay stable at long steps. The error of position is the present
one, as in PyBullet, where the paper takes the next one as well. `setJointMotorControlMultiDofArray` with
`STABLE_PD_CONTROL` is faster.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

_BASE_POSITIONS, _BASE_RATES = 7, 6
# Rates of a rotation, padded with a zero to the length of its quaternion.
_ROTATION = 4


class PDControllerStable:
    """For joints of one freedom.

    Lists have a value for each joint. Where the base is free, seven positions and six rates of the base come
    before; the base is taken to stand still and turned as it should be.
    """

    def __init__(self, pb: Any) -> None:
        """Takes the module `pybullet`, or a `BulletClient`."""
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
        """Torques [N m] that bring joints to positions.

        Args:
            bodyUniqueId: The body.
            jointIndices: All its joints.
            desiredPositions: Where they ought to be [rad or m].
            desiredVelocities: How fast they ought to move [rad/s or m/s].
            kps: Torque by error.
            kds: Torque by error of velocity.
            maxForces: Greatest torques.
            timeStep: Of the simulation [s].
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
    """For joints of any number of freedoms on a base that is free.

    Positions, rates, gains and torques come as PyBullet's flags=1 wants them: seven numbers for the base,
    then four for each spherical joint, of whose rates the last is idle, and one for each other joint. As in
    PyBullet no torque turns the base to its aim; only its rate is braked.
    """

    def __init__(self, pb: Any) -> None:
        """Takes the module `pybullet`, or a `BulletClient`."""
        self._pb = pb

    def computeAngVel(
        self, ornStart: Sequence[float], ornEnd: Sequence[float], deltaTime: float, bullet_client: Any
    ) -> list[float]:
        """Rate [rad/s] in world axes that turns one orientation to another in a time [s]."""
        turn = bullet_client.getDifferenceQuaternion(ornStart, ornEnd)
        axis, angle = bullet_client.getAxisAngleFromQuaternion(turn)
        return [component * angle / deltaTime for component in axis]

    def quatMul(self, q1: Sequence[float], q2: Sequence[float]) -> list[float]:
        """The rotation that turns as q2 does and then as q1."""
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
        """Rate [rad/s] in the axes of the first orientation that turns it to the second in a time [s]."""
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
        """Torques [N m] that bring base and joints to positions; those of the base lead the list.

        Args:
            bodyUniqueId: The body.
            jointIndices: All its joints that move.
            desiredPositions: Where they ought to be.
            desiredVelocities: How fast they ought to move.
            kps: Torque by error.
            kds: Torque by error of velocity.
            maxForces: Greatest torques.
            timeStep: Of the simulation [s].
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
    """Torque by error of position and of velocity, and the greatest torques, by freedom."""

    kp: Sequence[float]
    kd: Sequence[float]
    most: Sequence[float]


def _torques(
    gains: _Gains, masses: Any, bias: Any, errors: Sequence[float], rate_errors: np.ndarray, time_step: float
) -> np.ndarray:
    """The torques for errors of positions and of rates, given mass matrix and bias forces."""
    damping = np.asarray(gains.kd, dtype=float)
    wanted = np.multiply(gains.kp, errors) + damping * rate_errors
    acceleration = np.linalg.solve(
        np.asarray(masses) + np.diag(damping * time_step), wanted - np.asarray(bias)
    )
    most = np.asarray(gains.most)
    return np.clip(wanted - damping * acceleration * time_step, -most, most)
