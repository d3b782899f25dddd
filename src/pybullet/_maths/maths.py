"""Rotations and rigid transforms. None of these functions needs a connection.

PyBullet computes most of them in single precision; here they are in double precision throughout, and
only where single precision decides between two answers is it asked.
"""

from __future__ import annotations

from math import hypot, inf, isfinite, pi, sqrt
from struct import Struct

from carom.description.pose import Quaternion, Vector3
from carom.description.transform import (
    conjugate,
    multiplied,
    rotation_matrix,
    rpy_from_quaternion,
    transposed,
    turns_about_axes,
)
from carom.native.trigonometry import acos, asin, atan2, cos, sin
from pybullet._calls.arguments import Vector, quantity, real, rotation, vector3, vector4
from pybullet._calls.builtin import exported
from pybullet._calls.errors import fail
from pybullet._maths.rotations import canonical, turned, unit

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

_single = Struct("f")
# Ten times the spacing of single-precision numbers at 1.
_NO_AXIS = 10.0 * 1.1920928955078125e-07
# How far the squared length of a unit quaternion in single precision may be from 1.
_UNIT = 1e-6
# Squares of quaternions that have a direction, and of numbers that need no further look.
_SHORT, _COMMON = 1e-20, 1e40
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
        pybullet.error: It is not a sequence of three finite numbers.

    Examples:
        >>> [round(x, 4) for x in p.getQuaternionFromEuler([0, 0, 3.14159265 / 2])]
        [0.0, 0.0, 0.7071, 0.7071]
    """
    roll, pitch, yaw = vector3(
        eulerAngles, "Euler angles need a 3 coordinates [roll, pitch, yaw].", "eulerAngles"
    )
    x, y, z, w = turns_about_axes(roll, pitch, yaw)
    length = sqrt(x * x + y * y + z * z + w * w)
    return (x / length, y / length, z / length, w / length)


@exported
def getEulerFromQuaternion(quaternion: Vector, physicsClientId: int = 0) -> Vector3:
    """Roll, pitch and yaw of a rotation, the inverse of `getQuaternionFromEuler`.

    At a pitch of ±90 degrees roll and yaw turn about the same axis; roll is then 0.

    Args:
        quaternion: (x, y, z, w), of unit length.
        physicsClientId: Not used.

    Returns:
        (roll, pitch, yaw) [rad].

    Raises:
        pybullet.error: It is not a sequence of four finite numbers.

    Examples:
        >>> [round(x, 4) + 0.0 for x in p.getEulerFromQuaternion([0, 0, 0.6, 0.8])]
        [0.0, 0.0, 1.287]
    """
    return rpy_from_quaternion(vector4(quaternion, "Quaternion need a 4 components [x,y,z,w].", "quaternion"))


@exported
def getMatrixFromQuaternion(quaternion: Vector, physicsClientId: int = 0) -> tuple[float, ...]:
    """Rotation matrix of a quaternion.

    Args:
        quaternion: (x, y, z, w), of any length but 0.
        physicsClientId: Not used.

    Returns:
        Nine numbers, row after row.

    Raises:
        pybullet.error: It is not a sequence of four finite numbers, or its length is 0.

    Examples:
        >>> [round(x, 2) + 0.0 for x in p.getMatrixFromQuaternion([0, 0, 0.6, 0.8])]
        [0.28, -0.96, 0.0, 0.96, 0.28, 0.0, 0.0, 0.0, 1.0]
    """
    rows = rotation_matrix(rotation(quaternion, "Couldn't convert quaternion [x,y,z,w].", "quaternion"))
    return (*rows[0], *rows[1], *rows[2])


@exported
def multiplyTransforms(
    positionA: Vector, orientationA: Vector, positionB: Vector, orientationB: Vector, physicsClientId: int = 0
) -> tuple[Vector3, Quaternion]:
    """Pose of frame B, which is given in frame A, seen from where A is given.

    Args:
        positionA: Origin of A [m].
        orientationA: Its quaternion (x, y, z, w).
        positionB: Origin of B in A [m].
        orientationB: Its quaternion in A.
        physicsClientId: Not used.

    Returns:
        (position, orientation) of B.

    Raises:
        pybullet.error: An argument has not three, or four, finite numbers, or a quaternion has length 0.

    Examples:
        >>> position, orientation = p.multiplyTransforms([1, 0, 0], [0, 0, 1, 0], [1, 0, 0], [0, 0, 0, 1])
        >>> [round(x, 4) + 0.0 for x in position]
        [0.0, 0.0, 0.0]
    """
    try:
        pose = _composed(positionA, orientationA, positionB, orientationB)
        if pose is not None:
            return pose
    except (TypeError, ValueError):
        pass
    problem = "Invalid input: expected positionA [x,y,z], orientationA [x,y,z,w], positionB, orientationB."
    ax, ay, az = vector3(positionA, problem, "positionA")
    turn = unit(rotation(orientationA, problem, "orientationA"))
    x, y, z = turned(turn, vector3(positionB, problem, "positionB"))
    product = multiplied(turn, unit(rotation(orientationB, problem, "orientationB")))
    return (ax + x, ay + y, az + z), canonical(product)


def _composed(
    position_a: Vector, orientation_a: Vector, position_b: Vector, orientation_b: Vector
) -> tuple[Vector3, Quaternion] | None:
    """What `multiplyTransforms` gives, in one go, where all are numbers of Python and of common sizes."""
    ax, ay, az = position_a
    qx, qy, qz, qw = orientation_a
    bx, by, bz = position_b
    px, py, pz, pw = orientation_b
    square_a = qx * qx + qy * qy + qz * qz + qw * qw
    square_b = px * px + py * py + pz * pz + pw * pw
    check = ax * ax + ay * ay + az * az + bx * bx + by * by + bz * bz + square_a + square_b
    if type(check) is not float or not check < _COMMON or square_a < _SHORT or square_b < _SHORT:
        return None
    length = sqrt(square_a)
    qx, qy, qz, qw = qx / length, qy / length, qz / length, qw / length
    length = sqrt(square_b)
    px, py, pz, pw = px / length, py / length, pz / length, pw / length
    tx = 2.0 * (qy * bz - qz * by)
    ty = 2.0 * (qz * bx - qx * bz)
    tz = 2.0 * (qx * by - qy * bx)
    return (
        ax + (bx + qw * tx + qy * tz - qz * ty),
        ay + (by + qw * ty + qz * tx - qx * tz),
        az + (bz + qw * tz + qx * ty - qy * tx),
    ), canonical(
        (
            qw * px + qx * pw + qy * pz - qz * py,
            qw * py + qy * pw + qz * px - qx * pz,
            qw * pz + qz * pw + qx * py - qy * px,
            qw * pw - qx * px - qy * py - qz * pz,
        )
    )


@exported
def invertTransform(
    position: Vector, orientation: Vector, physicsClientId: int = 0
) -> tuple[Vector3, Quaternion]:
    """The inverse of a pose: of frame B in A, it gives that of A in B.

    Args:
        position: Origin [m].
        orientation: Quaternion (x, y, z, w).
        physicsClientId: Not used.

    Returns:
        (position, orientation).

    Raises:
        pybullet.error: An argument has not three, or four, finite numbers, or the quaternion has length 0.

    Examples:
        >>> position, orientation = p.invertTransform([1, 2, 3], [0, 0, 0, 1])
        >>> position
        (-1.0, -2.0, -3.0)
    """
    problem = "Invalid input: expected position [x,y,z] and orientation [x,y,z,w]."
    origin = vector3(position, problem, "position")
    turn = canonical(unit(conjugate(rotation(orientation, problem, "orientation"))))
    x, y, z = turned(turn, origin)
    return (-x, -y, -z), turn


@exported
def rotateVector(quaternion: Vector, vector: Vector, physicsClientId: int = 0) -> Vector3:
    """A vector turned by a quaternion.

    Args:
        quaternion: (x, y, z, w), of unit length.
        vector: Three numbers.
        physicsClientId: Not used.

    Returns:
        The turned vector.

    Raises:
        pybullet.error: An argument has not three, or four, finite numbers.

    Examples:
        >>> [round(x, 4) + 0.0 for x in p.rotateVector([0, 0, 1, 0], [1, 2, 3])]
        [-1.0, -2.0, 3.0]
    """
    problem = "Require quaternion with 4 components [x,y,z,w] and a vector [x,y,z]."
    q = vector4(quaternion, problem, "quaternion")
    x, y, z = vector3(vector, problem, "vector")
    x, y, z, _ = multiplied(multiplied(q, (x, y, z, 0.0)), conjugate(q))
    return (x, y, z)


@exported
def getQuaternionFromAxisAngle(axis: Vector, angle: float, physicsClientId: int = 0) -> Quaternion:
    """Quaternion of a rotation about an axis.

    Args:
        axis: Direction, of any length; the x axis when the length is 0.
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
    half = 0.5 * real(angle, "angle")
    length = hypot(*direction)
    if length == 0.0:
        return (sin(half), 0.0, 0.0, cos(half))
    s = sin(half) / length
    return (direction[0] * s, direction[1] * s, direction[2] * s, cos(half))


@exported
def getAxisAngleFromQuaternion(quaternion: Vector, physicsClientId: int = 0) -> tuple[Vector3, float]:
    """Axis and angle of a rotation.

    For angles below about 0.002 rad the axis is (1, 0, 0), whatever it was.

    Args:
        quaternion: (x, y, z, w), of unit length.
        physicsClientId: Not used.

    Returns:
        (axis, angle): unit vector, and angle from 0 to 2π [rad].

    Raises:
        pybullet.error: It is not a sequence of four finite numbers.

    Examples:
        >>> axis, angle = p.getAxisAngleFromQuaternion([0, 0, 1, 0])
        >>> axis, round(angle, 4)
        ((0.0, 0.0, 1.0), 3.1416)
    """
    x, y, z, w = vector4(quaternion, "Require a quaternion with 4 components [x,y,z,w].", "quaternion")
    # This close to no rotation the answer hangs on the rounding of w to single precision.
    w = _rounded_to_single(w)
    sine_squared = 1.0 - w * w
    angle = 2.0 * acos(max(-1.0, min(1.0, w)))
    if sine_squared < _NO_AXIS:
        return (1.0, 0.0, 0.0), angle
    s = 1.0 / sqrt(sine_squared)
    return (x * s, y * s, z * s), angle


@exported
def getQuaternionSlerp(
    quaternionStart: Vector, quaternionEnd: Vector, interpolationFraction: float, physicsClientId: int = 0
) -> Quaternion:
    """A rotation between two others, on the shorter way round and at constant speed.

    Args:
        quaternionStart: (x, y, z, w).
        quaternionEnd: (x, y, z, w).
        interpolationFraction: 0 gives the start, 1 the end or its negative.
        physicsClientId: Not used.

    Returns:
        (x, y, z, w).

    Raises:
        pybullet.error: An argument has not four finite numbers, or a quaternion has length 0.

    Examples:
        >>> [round(x, 4) for x in p.getQuaternionSlerp([0, 0, 0, 1], [0, 0, 1, 0], 0.5)]
        [0.0, 0.0, 0.7071, 0.7071]
    """
    a = rotation(quaternionStart, _TWO_QUATERNIONS, "quaternionStart")
    b = rotation(quaternionEnd, _TWO_QUATERNIONS, "quaternionEnd")
    fraction = quantity(interpolationFraction, "interpolationFraction")
    cosine = _dot4(a, b) / sqrt(_dot4(a, a) * _dot4(b, b))
    if abs(cosine) >= 1.0:
        return a
    sign = -1.0 if cosine < 0.0 else 1.0
    angle = acos(sign * cosine)
    from_a = sin((1.0 - fraction) * angle) / sin(angle)
    from_b = sin(sign * fraction * angle) / sin(angle)
    return (
        a[0] * from_a + b[0] * from_b,
        a[1] * from_a + b[1] * from_b,
        a[2] * from_a + b[2] * from_b,
        a[3] * from_a + b[3] * from_b,
    )


@exported
def getDifferenceQuaternion(
    quaternionStart: Vector, quaternionEnd: Vector, physicsClientId: int = 0
) -> Quaternion:
    """The rotation that leads from one to another, in world axes: end · start⁻¹, on the shorter way.

    Args:
        quaternionStart: (x, y, z, w), of unit length.
        quaternionEnd: (x, y, z, w), of unit length.
        physicsClientId: Not used.

    Returns:
        (x, y, z, w).

    Raises:
        pybullet.error: An argument has not four finite numbers.

    Examples:
        >>> [round(x, 4) for x in p.getDifferenceQuaternion([0, 0, 0, 1], [0, 0, 0.6, 0.8])]
        [0.0, 0.0, 0.6, 0.8]
    """
    return _difference(
        vector4(quaternionStart, _TWO_QUATERNIONS, "quaternionStart"),
        vector4(quaternionEnd, _TWO_QUATERNIONS, "quaternionEnd"),
    )


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
        pybullet.error: An argument has not four finite numbers, or a quaternion has length 0.

    Examples:
        >>> [round(x, 4) + 0.0 for x in p.getAxisDifferenceQuaternion([0, 0, 0, 1], [0, 0, 0.6, 0.8])]
        [0.0, 0.0, -1.287]
    """
    start = rotation(quaternionStart, _TWO_QUATERNIONS, "quaternionStart")
    end = rotation(quaternionEnd, _TWO_QUATERNIONS, "quaternionEnd")
    m = transposed(rotation_matrix(multiplied(conjugate(start), end)))
    sine = m[0][2]
    if sine >= 1.0:
        return (atan2(m[1][0], m[1][1]), 0.5 * pi, 0.0)
    if sine <= -1.0:
        return (-atan2(m[1][0], m[1][1]), -0.5 * pi, 0.0)
    return (atan2(-m[1][2], m[2][2]), asin(sine), atan2(-m[0][1], m[0][0]))


@exported
def calculateVelocityQuaternion(
    quaternionStart: Vector, quaternionEnd: Vector, deltaTime: float, physicsClientId: int = 0
) -> Vector3:
    """Constant angular velocity that leads from one rotation to another, on the shorter way round.

    Args:
        quaternionStart: (x, y, z, w), of unit length.
        quaternionEnd: (x, y, z, w), of unit length.
        deltaTime: Time it takes [s].
        physicsClientId: Not used.

    Returns:
        Angular velocity in world axes [rad/s].

    Raises:
        pybullet.error: An argument has not four finite numbers, or the time is 0 or not finite.

    Examples:
        >>> [round(x, 4) for x in p.calculateVelocityQuaternion([0, 0, 0, 1], [0, 0, 0.6, 0.8], 0.1)]
        [0.0, 0.0, 12.87]
    """
    start = vector4(quaternionStart, _TWO_QUATERNIONS, "quaternionStart")
    end = vector4(quaternionEnd, _TWO_QUATERNIONS, "quaternionEnd")
    duration = real(deltaTime, "deltaTime")
    x, y, z, w = _difference(start, end)
    sine = hypot(x, y, z)
    if sine == 0.0:
        return (0.0, 0.0, 0.0)
    if duration == 0.0:
        fail("deltaTime has to be different from 0.")
    # Of quaternions that are not of unit length PyBullet looks at w alone.
    is_unit = abs(sine * sine + w * w - 1.0) < _UNIT
    angle = 2.0 * (atan2(sine, w) if is_unit else acos(max(-1.0, min(1.0, w))))
    scale = angle / (sine * duration) if sine * duration else inf
    if not isfinite(scale):
        fail(f"deltaTime is {duration:g}, which is too small.")
    return (x * scale, y * scale, z * scale)


def _difference(start: Quaternion, end: Quaternion) -> Quaternion:
    """End · start⁻¹ with the nearer of the two quaternions of `end`."""
    x, y, z, w = end
    nearest = end if _dot4(start, end) > 0.0 else (-x, -y, -z, -w)
    return multiplied(nearest, conjugate(start))


def _dot4(a: Quaternion, b: Quaternion) -> float:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3]


def _rounded_to_single(value: float) -> float:
    return _single.unpack(_single.pack(value))[0]
