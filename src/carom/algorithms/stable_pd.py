"""Stable proportional-derivative control.

The controller of Tan, Liu and Turk (Stable Proportional-Derivative Controllers, 2011): the position error
is the one expected after the next step, and so is the velocity error, for which the equations of motion
are solved together with the damping of the controller. High gains then stay stable at long steps.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import acos, sqrt
from typing import TYPE_CHECKING

import numpy as np

from carom.algorithms.extended_model import ExtendedModel
from carom.algorithms.extended_nodes import ROOT_COORDINATES, extended_nodes
from carom.description.pose import Quaternion
from carom.description.transform import conjugate, multiplied
from carom.model.codes import BASE_POSITIONS, BASE_VELOCITIES, JointCode

if TYPE_CHECKING:
    from carom.body import Body

_UNSTATED_FORCE = 100000.0
_NO_TURN = (0.0, 0.0, 0.0, 1.0)
_NO_ANGLE = 1e-6


@dataclass(frozen=True, slots=True)
class JointTarget:
    """What a joint is to do. Lists of a length that does not fit the joint count as not given.

    Attributes:
        position: One number [rad or m], or a quaternion (x, y, z, w); 0 or no rotation when not given.
        velocity: One number [rad/s or m/s], or three; 0 when not given.
        force: Greatest torques [N m or N] by freedom; one number of a spherical joint holds for its first.
        kp: Torque by error.
        kd: Torque by error of velocity.
    """

    position: Sequence[float]
    velocity: Sequence[float]
    force: Sequence[float]
    kp: float
    kd: float


@dataclass(frozen=True, slots=True)
class _Coordinates:
    """State, aims and gains in extended coordinates; quaternions (x, y, z, w), rates padded with a zero."""

    position: np.ndarray
    rate: np.ndarray
    target: np.ndarray
    target_rate: np.ndarray
    kp: np.ndarray
    kd: np.ndarray
    most: np.ndarray


def stable_pd_torques(body: Body, targets: Mapping[int, JointTarget], time_step: float) -> np.ndarray:
    """Torques that lead joints to their targets.

    With a floating base the equations of motion are those PyBullet solves, see `extended_nodes`; with a
    fixed one, where PyBullet mixes up coordinates, they are the body's own.

    Args:
        body: The body.
        targets: By joint index; other joints get no torque.
        time_step: Of the step to come [s].

    Returns:
        Torques by velocity coordinate of the body, zeros for its base first.

    Raises:
        ValueError: A joint is planar.
        DescriptionError: The file of a collision mesh cannot be used.
    """
    nodes = extended_nodes(body, as_pybullet=not body.fixed_base)
    coordinates = _coordinates(body, targets, nodes[-1].first + nodes[-1].count)
    model = ExtendedModel(nodes, coordinates.position)
    error = _expected_errors(body, coordinates, time_step)
    rate_error = coordinates.target_rate - coordinates.rate
    torque = coordinates.kp * error + coordinates.kd * rate_error
    bias = model.bias_forces(coordinates.rate, body.world.parameters.gravity)
    matrix = model.mass_matrix()
    matrix[np.diag_indices_from(matrix)] += time_step * coordinates.kd
    moving = matrix.diagonal() > 0.0
    if body.fixed_base:
        moving[:ROOT_COORDINATES] = False
    acceleration = np.zeros(model.size)
    acceleration[moving] = np.linalg.solve(matrix[np.ix_(moving, moving)], (torque - bias)[moving])
    torque = torque - time_step * coordinates.kd * acceleration
    return _by_freedom(body, np.clip(torque, -coordinates.most, coordinates.most))


def _coordinates(body: Body, targets: Mapping[int, JointTarget], size: int) -> _Coordinates:
    arrays = _Coordinates(*(np.zeros(size) for _ in range(7)))
    world, q, u = body.world, body.first_position, body.first_velocity
    arrays.position[:ROOT_COORDINATES] = world.position[q : q + BASE_POSITIONS]
    arrays.target[:ROOT_COORDINATES] = arrays.position[:ROOT_COORDINATES]
    arrays.rate[:3] = world.velocity[u + 3 : u + 6]
    arrays.rate[3:6] = world.velocity[u : u + 3]
    first = ROOT_COORDINATES
    for joint, count in enumerate(body.position_count):
        freedoms = body.velocity_count[joint]
        own, moving = slice(first, first + count), slice(first, first + freedoms)
        if count:
            q, u = body.position_index[joint], body.velocity_index[joint]
            arrays.position[own] = world.position[q : q + count]
            arrays.rate[moving] = world.velocity[u : u + freedoms]
            arrays.target[own] = _NO_TURN if count == 4 else 0.0
        target = targets.get(joint)
        if target is not None and count:
            if len(target.position) == count:
                arrays.target[own] = target.position
            if len(target.velocity) == freedoms:
                arrays.target_rate[moving] = target.velocity
            arrays.kp[own], arrays.kd[own] = target.kp, target.kd
            arrays.most[moving] = _UNSTATED_FORCE
            arrays.most[first : first + len(target.force[:freedoms])] = target.force[:freedoms]
        first += count
    return arrays


def _expected_errors(body: Body, coordinates: _Coordinates, time_step: float) -> np.ndarray:
    """From where the joints will be after a step at their present rates to where they ought to be."""
    error = coordinates.target - coordinates.position - time_step * coordinates.rate
    error[:ROOT_COORDINATES] = 0.0
    first = ROOT_COORDINATES
    for kind, count in zip(body.joint_types, body.position_count, strict=True):
        if kind == JointCode.SPHERICAL:
            own = slice(first, first + 4)
            ahead = _advanced(coordinates.position[own], coordinates.rate[own], time_step)
            error[own] = _turn_between(ahead, _quaternion(coordinates.target[own]))
        first += count
    return error


def _advanced(position: np.ndarray, rate: np.ndarray, time_step: float) -> Quaternion:
    """A rotation after one explicit step at an angular velocity in its own axes."""
    q = _quaternion(position)
    wx, wy, wz, _ = rate.tolist()
    change = multiplied(q, (0.5 * time_step * wx, 0.5 * time_step * wy, 0.5 * time_step * wz, 0.0))
    x, y, z, w = (a + b for a, b in zip(q, change, strict=True))
    length = sqrt(x * x + y * y + z * z + w * w)
    return (x / length, y / length, z / length, w / length)


def _turn_between(start: Quaternion, end: Quaternion) -> tuple[float, float, float, float]:
    """Rotation vector from one rotation to another, in the axes of the first, and a zero."""
    x, y, z, w = multiplied(conjugate(start), end)
    w = max(-1.0, min(1.0, w))
    sine = sqrt(1.0 - w * w)
    if sine <= _NO_ANGLE:
        return (0.0, 0.0, 0.0, 0.0)
    angle = 2.0 * acos(w)
    if angle > np.pi:
        angle -= 2.0 * np.pi
    return (x / sine * angle, y / sine * angle, z / sine * angle, 0.0)


def _quaternion(values: np.ndarray) -> Quaternion:
    x, y, z, w = values.tolist()
    return (x, y, z, w)


def _by_freedom(body: Body, torque: np.ndarray) -> np.ndarray:
    """Torques without the fourth coordinate of spherical joints, after those of the base."""
    result = [np.zeros(BASE_VELOCITIES)]
    first = ROOT_COORDINATES
    for count, freedoms in zip(body.position_count, body.velocity_count, strict=True):
        result.append(torque[first : first + freedoms])
        first += count
    return np.concatenate(result)
