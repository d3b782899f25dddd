"""View and projection matrices, as OpenGL stores them: 16 numbers, column after column."""

from __future__ import annotations

from math import hypot, pi, radians

from carom.description.pose import Vector3
from carom.description.transform import dot, subtracted
from carom.native.trigonometry import cos, sin, tan
from pybullet._calls.arguments import Vector, integer, real, vector3
from pybullet._calls.builtin import exported
from pybullet._calls.errors import fail

__all__ = [
    "computeProjectionMatrix",
    "computeProjectionMatrixFOV",
    "computeViewMatrix",
    "computeViewMatrixFromYawPitchRoll",
]

Matrix16 = tuple[float, ...]

Y_UP, Z_UP = 1, 2
# The planes of the window's camera [m].
_NEAR, _FAR = 0.01, 1000.0


def cross(a: Vector3, b: Vector3) -> Vector3:
    """Vector product."""
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def unit(v: Vector3) -> Vector3 | None:
    """A vector normalised to length 1; None for the zero vector."""
    length = hypot(*v)
    return (v[0] / length, v[1] / length, v[2] / length) if length > 0.0 else None


def look_at(eye: Vector3, target: Vector3, up: Vector3) -> Matrix16 | None:
    """View matrix: world to camera frame (x right, y up, z towards the viewer). None if it does not exist."""
    forward = unit(subtracted(target, eye))
    right = unit(cross(forward, up)) if forward else None
    if forward is None or right is None:
        return None
    upward = cross(right, forward)
    rotation: list[float] = []
    for axis in range(3):
        rotation += (right[axis], upward[axis], -forward[axis], 0.0)
    return (*rotation, -dot(right, eye), -dot(upward, eye), dot(forward, eye), 1.0)


def orbit(
    target: Vector3, distance: float, yaw: float, pitch: float, roll: float, up_axis: int
) -> tuple[Vector3, Vector3]:
    """Eye and up vector of a camera that orbits a target [m]; angles [degrees]; `up_axis` 1 is y, 2 is z."""
    if up_axis == Z_UP:
        turn = _rotation_zyx(radians(yaw), radians(roll), radians(pitch))
        forward, up = (0.0, -distance, 0.0), (0.0, 0.0, 1.0)
    else:
        turn = _rotation_zyx(radians(roll), radians(yaw), -radians(pitch))
        forward, up = (0.0, 0.0, -distance), (0.0, 1.0, 0.0)
    x, y, z = (dot(row, forward) for row in turn)
    eye = (target[0] + x, target[1] + y, target[2] + z)
    return eye, (dot(turn[0], up), dot(turn[1], up), dot(turn[2], up))


def frustum(left: float, right: float, bottom: float, top: float, near: float, far: float) -> Matrix16:
    """Perspective projection through a rectangle on the near plane."""
    width, height, depth = right - left, top - bottom, far - near
    return (
        *(2.0 * near / width, 0.0, 0.0, 0.0),
        *(0.0, 2.0 * near / height, 0.0, 0.0),
        *((right + left) / width, (top + bottom) / height, -(far + near) / depth, -1.0),
        *(0.0, 0.0, -2.0 * far * near / depth, 0.0),
    )


def window_lens(aspect: float) -> Matrix16:
    """Projection matrix of the window's camera; `aspect` is the image's width divided by its height."""
    return frustum(-aspect * _NEAR, aspect * _NEAR, -_NEAR, _NEAR, _NEAR, _FAR)


def _rotation_zyx(z: float, y: float, x: float) -> tuple[Vector3, Vector3, Vector3]:
    """The rows of the rotation matrix Rz(z) Ry(y) Rx(x); angles in radians."""
    sz, cz, sy, cy, sx, cx = sin(z), cos(z), sin(y), cos(y), sin(x), cos(x)
    return (
        (cz * cy, cz * sy * sx - sz * cx, cz * sy * cx + sz * sx),
        (sz * cy, sz * sy * sx + cz * cx, sz * sy * cx - cz * sx),
        (-sy, cy * sx, cy * cx),
    )


@exported
def computeViewMatrix(
    cameraEyePosition: Vector, cameraTargetPosition: Vector, cameraUpVector: Vector, physicsClientId: int = 0
) -> Matrix16:
    """View matrix of a camera from its position and target. Needs no connection.

    Args:
        cameraEyePosition: Position of the camera [m], world frame.
        cameraTargetPosition: Point that it looks at [m], world frame.
        cameraUpVector: Upward direction; need not have unit length or be perpendicular to the view.
        physicsClientId: Not used.

    Returns:
        16 numbers, column after column, for `getCameraImage`.

    Raises:
        pybullet.error: A vector does not have three finite numbers, eye and target coincide, or the camera
            looks along its upward direction.

    Examples:
        >>> view = p.computeViewMatrix([0, 0, 5], [0, 0, 0], [0, 1, 0])
        >>> [x + 0.0 for x in view[12:15]]
        [0.0, 0.0, -5.0]
    """
    problem = "Error in computeViewMatrix."
    matrix = look_at(
        vector3(cameraEyePosition, problem, "cameraEyePosition"),
        vector3(cameraTargetPosition, problem, "cameraTargetPosition"),
        vector3(cameraUpVector, problem, "cameraUpVector"),
    )
    if matrix is None:
        fail(problem, "The camera looks at its own position or straight along cameraUpVector.")
    return matrix


@exported
def computeViewMatrixFromYawPitchRoll(
    cameraTargetPosition: Vector,
    distance: float,
    yaw: float,
    pitch: float,
    roll: float,
    upAxisIndex: int,
    physicsClientId: int = 0,
) -> Matrix16:
    """View matrix of a camera that circles a target. Needs no connection.

    Args:
        cameraTargetPosition: Point that the camera looks at [m], world frame.
        distance: From the target to the camera [m].
        yaw: About the upward axis [degrees].
        pitch: Upwards; negative looks down from above [degrees].
        roll: About the viewing direction [degrees].
        upAxisIndex: The upward axis: 1 for y, 2 for z.
        physicsClientId: Not used.

    Returns:
        16 numbers, column after column, for `getCameraImage`.

    Raises:
        pybullet.error: The target is not three finite numbers, a number is not finite, the distance is
            0, or the upward axis is neither 1 nor 2.

    Examples:
        >>> view = p.computeViewMatrixFromYawPitchRoll([0, 0, 0], 2, 0, 0, 0, 2)
        >>> round(view[14], 6)
        -2.0
    """
    problem = "Cannot convert cameraTargetPosition."
    target = vector3(cameraTargetPosition, problem, "cameraTargetPosition")
    up_axis = integer(upAxisIndex, "upAxisIndex")
    if up_axis not in (Y_UP, Z_UP):
        fail(f"upAxisIndex has to be 1 (y) or 2 (z), not {up_axis}.")
    eye, up = orbit(
        target,
        real(distance, "distance"),
        real(yaw, "yaw"),
        real(pitch, "pitch"),
        real(roll, "roll"),
        up_axis,
    )
    matrix = look_at(eye, target, up)
    if matrix is None:
        fail("distance has to be different from 0.")
    return matrix


@exported
def computeProjectionMatrix(
    left: float,
    right: float,
    bottom: float,
    top: float,
    nearVal: float,
    farVal: float,
    physicsClientId: int = 0,
) -> Matrix16:
    """Projection matrix of a view through a rectangle on the near plane. Needs no connection.

    Args:
        left: Left edge of the rectangle [m].
        right: Right edge [m].
        bottom: Lower edge [m].
        top: Upper edge [m].
        nearVal: Distance of the near plane [m].
        farVal: Distance of the far plane [m].
        physicsClientId: Not used.

    Returns:
        16 numbers, column after column, for `getCameraImage`.

    Raises:
        pybullet.error: A number is not finite, or two edges or the two planes coincide.

    Examples:
        >>> len(p.computeProjectionMatrix(-0.1, 0.1, -0.1, 0.1, 0.1, 10))
        16
    """
    edges = [real(value, name) for value, name in ((left, "left"), (right, "right"))]
    sides = [real(value, name) for value, name in ((bottom, "bottom"), (top, "top"))]
    planes = [real(value, name) for value, name in ((nearVal, "nearVal"), (farVal, "farVal"))]
    for (first, second), names in (
        (edges, "left and right"),
        (sides, "bottom and top"),
        (planes, "nearVal and farVal"),
    ):
        if first == second:
            fail(f"{names} have to be different, not both {first}.")
    return frustum(*edges, *sides, *planes)


@exported
def computeProjectionMatrixFOV(
    fov: float, aspect: float, nearVal: float, farVal: float, physicsClientId: int = 0
) -> Matrix16:
    """Projection matrix of a symmetric view. Needs no connection.

    Args:
        fov: Vertical field of view [degrees].
        aspect: Width of the image divided by its height.
        nearVal: Distance of the near plane [m].
        farVal: Distance of the far plane [m].
        physicsClientId: Not used.

    Returns:
        16 numbers, column after column, for `getCameraImage`.

    Raises:
        pybullet.error: A number is not finite, `fov` or `aspect` is 0, or the two planes coincide.

    Examples:
        >>> round(p.computeProjectionMatrixFOV(90, 1, 0.1, 10)[0], 6)
        1.0
    """
    half_height = tan(pi / 180.0 * real(fov, "fov") / 2.0)
    ratio = real(aspect, "aspect")
    near, far = real(nearVal, "nearVal"), real(farVal, "farVal")
    if half_height == 0.0 or ratio == 0.0 or near == far:
        fail("fov and aspect have to be different from 0, and nearVal from farVal.")
    y_scale = 1.0 / half_height
    return (
        *(y_scale / ratio, 0.0, 0.0, 0.0),
        *(0.0, y_scale, 0.0, 0.0),
        *(0.0, 0.0, (near + far) / (near - far), -1.0),
        *(0.0, 0.0, 2.0 * far * near / (near - far), 0.0),
    )
