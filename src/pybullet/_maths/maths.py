"""Rotations and rigid transforms. None of these functions needs a connection.

PyBullet computes most of them in single precision; here they are in double precision, and single precision is
used only where it decides between two results. The native library, which tries these calls first
(`pybullet._calls.quick`), computes all of them: these functions convert and check arguments.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from carom.description.pose import Quaternion, Vector3
from carom.native.number_kernels import worked_out
from pybullet._calls.arguments import Vector, quantity, real, rotation, vector3, vector4
from pybullet._calls.builtin import exported
from pybullet._calls.errors import fail
from pybullet._calls.quick import install

__all__ = [
    "calculateVelocityQuaternion",
    "getAxisAngleFromQuaternion",
    "getAxisDifferenceQuaternion",
    "getDifferenceQuaternion",
    "getEulerFromQuaternion",
    "getMatrixFromQuaternion",
    "getQuaternionFromAxisAngle",
    "getQuaternionFromEuler",
    "getQuaternionSlerp",
    "invertTransform",
    "multiplyTransforms",
    "rotateVector",
]

_TWO_QUATERNIONS = "Require start and end quaternion, each with 4 components [x,y,z,w]."


@exported
def getQuaternionFromEuler(eulerAngles: Vector, physicsClientId: int = 0) -> Quaternion:
    """Quaternion of a rotation by roll about x, then pitch about y, then yaw about z, all fixed axes.

    Args:
        eulerAngles: Roll, pitch and yaw [rad].
        physicsClientId: Not used.

    Returns:
        (x, y, z, w), of unit length.

    Raises:
        pybullet.error: `eulerAngles` is not a sequence of three finite numbers.

    Examples:
        >>> [round(x, 4) for x in p.getQuaternionFromEuler([0, 0, 3.14159265 / 2])]
        [0.0, 0.0, 0.7071, 0.7071]
    """
    problem = "Euler angles need a 3 coordinates [roll, pitch, yaw]."
    return _computed("quaternion_from_euler", vector3(eulerAngles, problem, "eulerAngles"), 4)


@exported
def getEulerFromQuaternion(quaternion: Vector, physicsClientId: int = 0) -> Vector3:
    """Roll, pitch and yaw of a rotation, the inverse of `getQuaternionFromEuler`.

    At a pitch of ±90 degrees (gimbal lock) roll and yaw rotate about the same axis; roll is then 0.

    Args:
        quaternion: (x, y, z, w), of unit length.
        physicsClientId: Not used.

    Returns:
        (roll, pitch, yaw) [rad].

    Raises:
        pybullet.error: The quaternion is not a sequence of four finite numbers.

    Examples:
        >>> [round(x, 4) + 0.0 for x in p.getEulerFromQuaternion([0, 0, 0.6, 0.8])]
        [0.0, 0.0, 1.287]
    """
    problem = "Quaternion need a 4 components [x,y,z,w]."
    return _computed("euler_from_quaternion", vector4(quaternion, problem, "quaternion"), 3)


@exported
def getMatrixFromQuaternion(quaternion: Vector, physicsClientId: int = 0) -> tuple[float, ...]:
    """Rotation matrix of a quaternion.

    Args:
        quaternion: (x, y, z, w), of any length but 0.
        physicsClientId: Not used.

    Returns:
        Nine numbers, row after row.

    Raises:
        pybullet.error: The quaternion is not a sequence of four finite numbers, or its length is 0.

    Examples:
        >>> [round(x, 2) + 0.0 for x in p.getMatrixFromQuaternion([0, 0, 0.6, 0.8])]
        [0.28, -0.96, 0.0, 0.96, 0.28, 0.0, 0.0, 0.0, 1.0]
    """
    problem = "Couldn't convert quaternion [x,y,z,w]."
    return _computed("matrix_from_quaternion", rotation(quaternion, problem, "quaternion"), 9)


@exported
def multiplyTransforms(
    positionA: Vector, orientationA: Vector, positionB: Vector, orientationB: Vector, physicsClientId: int = 0
) -> tuple[Vector3, Quaternion]:
    """Composes two poses: frame B is given in frame A; returns B in the reference frame of A.

    Args:
        positionA: Origin of A [m].
        orientationA: Its quaternion (x, y, z, w).
        positionB: Origin of B in A [m].
        orientationB: Its quaternion in A.
        physicsClientId: Not used.

    Returns:
        (position, orientation) of B.

    Raises:
        pybullet.error: An argument does not have three, or four, finite numbers, or a quaternion has length
            0.

    Examples:
        >>> position, orientation = p.multiplyTransforms([1, 0, 0], [0, 0, 1, 0], [1, 0, 0], [0, 0, 0, 1])
        >>> [round(x, 4) + 0.0 for x in position]
        [0.0, 0.0, 0.0]
    """
    problem = "Invalid input: expected positionA [x,y,z], orientationA [x,y,z,w], positionB, orientationB."
    return _pose(
        "multiply_transforms",
        (
            *vector3(positionA, problem, "positionA"),
            *rotation(orientationA, problem, "orientationA"),
            *vector3(positionB, problem, "positionB"),
            *rotation(orientationB, problem, "orientationB"),
        ),
    )


@exported
def invertTransform(
    position: Vector, orientation: Vector, physicsClientId: int = 0
) -> tuple[Vector3, Quaternion]:
    """The inverse of a pose: for frame B given in frame A, the pose of A in B.

    Args:
        position: Origin of B in A [m].
        orientation: Quaternion of B in A (x, y, z, w).
        physicsClientId: Not used.

    Returns:
        (position, orientation) of A in B.

    Raises:
        pybullet.error: An argument does not have three, or four, finite numbers, or the quaternion has length
            0.

    Examples:
        >>> position, orientation = p.invertTransform([1, 2, 3], [0, 0, 0, 1])
        >>> position
        (-1.0, -2.0, -3.0)
    """
    problem = "Invalid input: expected position [x,y,z] and orientation [x,y,z,w]."
    origin = vector3(position, problem, "position")
    return _pose("invert_transform", (*origin, *rotation(orientation, problem, "orientation")))


@exported
def rotateVector(quaternion: Vector, vector: Vector, physicsClientId: int = 0) -> Vector3:
    """Rotates a vector by a quaternion.

    Args:
        quaternion: (x, y, z, w), of unit length.
        vector: Three numbers.
        physicsClientId: Not used.

    Returns:
        The rotated vector.

    Raises:
        pybullet.error: An argument does not have three, or four, finite numbers.

    Examples:
        >>> [round(x, 4) + 0.0 for x in p.rotateVector([0, 0, 1, 0], [1, 2, 3])]
        [-1.0, -2.0, 3.0]
    """
    problem = "Require quaternion with 4 components [x,y,z,w] and a vector [x,y,z]."
    turn = vector4(quaternion, problem, "quaternion")
    return _computed("rotate_vector", (*turn, *vector3(vector, problem, "vector")), 3)


@exported
def getQuaternionFromAxisAngle(axis: Vector, angle: float, physicsClientId: int = 0) -> Quaternion:
    """Quaternion of a rotation about an axis.

    Args:
        axis: Direction, of any length; the x axis if the length is 0.
        angle: Angle [rad].
        physicsClientId: Not used.

    Returns:
        (x, y, z, w), of unit length.

    Raises:
        pybullet.error: The axis is not three finite numbers, or the angle is not finite.

    Examples:
        >>> [round(x, 4) for x in p.getQuaternionFromAxisAngle([0, 0, 1], 3.14159265)]
        [0.0, 0.0, 1.0, 0.0]
    """
    problem = "Require axis [x,y,z] and angle."
    direction = vector3(axis, problem, "axis")
    return _computed("quaternion_from_axis_angle", (*direction, real(angle, "angle")), 4)


@exported
def getAxisAngleFromQuaternion(quaternion: Vector, physicsClientId: int = 0) -> tuple[Vector3, float]:
    """Axis and angle of a rotation.

    For angles below about 0.002 rad the axis is always (1, 0, 0).

    Args:
        quaternion: (x, y, z, w), of unit length.
        physicsClientId: Not used.

    Returns:
        (axis, angle): unit vector, and angle from 0 to 2π [rad].

    Raises:
        pybullet.error: The quaternion is not a sequence of four finite numbers.

    Examples:
        >>> axis, angle = p.getAxisAngleFromQuaternion([0, 0, 1, 0])
        >>> axis, round(angle, 4)
        ((0.0, 0.0, 1.0), 3.1416)
    """
    problem = "Require a quaternion with 4 components [x,y,z,w]."
    turn = vector4(quaternion, problem, "quaternion")
    x, y, z, angle = _computed("axis_angle_from_quaternion", turn, 4)
    return (x, y, z), angle


@exported
def getQuaternionSlerp(
    quaternionStart: Vector, quaternionEnd: Vector, interpolationFraction: float, physicsClientId: int = 0
) -> Quaternion:
    """Spherical linear interpolation (slerp) between two rotations, by the shorter way.

    Args:
        quaternionStart: (x, y, z, w).
        quaternionEnd: (x, y, z, w).
        interpolationFraction: 0 gives the start, 1 the end or its negative.
        physicsClientId: Not used.

    Returns:
        (x, y, z, w).

    Raises:
        pybullet.error: A quaternion does not have four finite numbers or has length 0, or the fraction is not
            a finite number.

    Examples:
        >>> [round(x, 4) for x in p.getQuaternionSlerp([0, 0, 0, 1], [0, 0, 1, 0], 0.5)]
        [0.0, 0.0, 0.7071, 0.7071]
    """
    a = rotation(quaternionStart, _TWO_QUATERNIONS, "quaternionStart")
    b = rotation(quaternionEnd, _TWO_QUATERNIONS, "quaternionEnd")
    fraction = quantity(interpolationFraction, "interpolationFraction")
    return _computed("quaternion_slerp", (*a, *b, fraction), 4)


@exported
def getDifferenceQuaternion(
    quaternionStart: Vector, quaternionEnd: Vector, physicsClientId: int = 0
) -> Quaternion:
    """The rotation from one orientation to another, in world axes: end · start⁻¹, by the shorter way.

    Args:
        quaternionStart: (x, y, z, w), of unit length.
        quaternionEnd: (x, y, z, w), of unit length.
        physicsClientId: Not used.

    Returns:
        (x, y, z, w).

    Raises:
        pybullet.error: An argument does not have four finite numbers.

    Examples:
        >>> [round(x, 4) for x in p.getDifferenceQuaternion([0, 0, 0, 1], [0, 0, 0.6, 0.8])]
        [0.0, 0.0, 0.6, 0.8]
    """
    start = vector4(quaternionStart, _TWO_QUATERNIONS, "quaternionStart")
    end = vector4(quaternionEnd, _TWO_QUATERNIONS, "quaternionEnd")
    return _computed("difference_quaternion", (*start, *end), 4)


@exported
def getAxisDifferenceQuaternion(
    quaternionStart: Vector, quaternionEnd: Vector, physicsClientId: int = 0
) -> Vector3:
    """Angles between two rotations about x, y and z, as spherical joint motors measure them.

    Args:
        quaternionStart: (x, y, z, w), of unit length.
        quaternionEnd: (x, y, z, w), of unit length.
        physicsClientId: Not used.

    Returns:
        Angles (a, b, c) [rad] with start⁻¹ · end = Rz(-c) Ry(-b) Rx(-a).

    Raises:
        pybullet.error: An argument does not have four finite numbers, or a quaternion has length 0.

    Examples:
        >>> [round(x, 4) + 0.0 for x in p.getAxisDifferenceQuaternion([0, 0, 0, 1], [0, 0, 0.6, 0.8])]
        [0.0, 0.0, -1.287]
    """
    start = rotation(quaternionStart, _TWO_QUATERNIONS, "quaternionStart")
    end = rotation(quaternionEnd, _TWO_QUATERNIONS, "quaternionEnd")
    return _computed("axis_difference_quaternion", (*start, *end), 3)


@exported
def calculateVelocityQuaternion(
    quaternionStart: Vector, quaternionEnd: Vector, deltaTime: float, physicsClientId: int = 0
) -> Vector3:
    """Constant angular velocity from one orientation to another, by the shorter way.

    Args:
        quaternionStart: (x, y, z, w), of unit length.
        quaternionEnd: (x, y, z, w), of unit length.
        deltaTime: Duration of the rotation [s].
        physicsClientId: Not used.

    Returns:
        Angular velocity in world axes [rad/s].

    Raises:
        pybullet.error: A quaternion does not have four finite numbers, or the duration is not finite, 0, or
            too small.

    Examples:
        >>> [round(x, 4) for x in p.calculateVelocityQuaternion([0, 0, 0, 1], [0, 0, 0.6, 0.8], 0.1)]
        [0.0, 0.0, 12.87]
    """
    start = vector4(quaternionStart, _TWO_QUATERNIONS, "quaternionStart")
    end = vector4(quaternionEnd, _TWO_QUATERNIONS, "quaternionEnd")
    duration = real(deltaTime, "deltaTime")
    velocity: Any = worked_out("velocity_quaternion", (*start, *end, duration), 3)
    if velocity is None:
        if duration == 0.0:
            fail("deltaTime has to be different from 0.")
        fail(f"deltaTime is {duration:g}, which is too small.")
    return velocity


def _computed(kernel: str, numbers: Sequence[float], count: int) -> Any:
    """The results, so many, of a kernel that has results for all numbers."""
    # From now on builtins call the native library directly, if possible.
    install()
    result = worked_out(kernel, numbers, count)
    assert result is not None
    return result


def _pose(kernel: str, numbers: Sequence[float]) -> tuple[Vector3, Quaternion]:
    result = _computed(kernel, numbers, 7)
    return result[:3], result[3:]
