"""The oldest function for images, with five forms of arguments."""

from __future__ import annotations

from typing import Any

from pybullet._calls.arguments import numbers, vector3
from pybullet._calls.builtin import exported_as
from pybullet._calls.errors import fail
from pybullet._cameras.camera import getCameraImage
from pybullet._maths.camera_maths import (
    computeProjectionMatrixFOV,
    computeViewMatrix,
    computeViewMatrixFromYawPitchRoll,
)

__all__ = ["renderImage"]

_BAD_MATRIX = "Error parsing view or projection matrix."
_BAD_CAMERA = "Error parsing camera position, target or up."
_BAD_TARGET = "Error parsing camera target pos"
_DEFAULT_FIELD_OF_VIEW = 90.0


@exported_as("(*arguments)")
def renderImage(*arguments: Any) -> Any:
    """Renders an image of the first connection; newer scripts use `getCameraImage`.

    Called as `renderImage(width, height)`, `(width, height, viewMatrix, projectionMatrix)`,
    `(width, height, cameraPosition, cameraTarget, cameraUp, near, far)`, the same with a field of view
    [degrees] at the end (90 otherwise), or `(width, height, target, distance, yaw, pitch, roll,
    upAxisIndex, near, far, fieldOfView)` with angles in degrees. In the last three forms the horizontal and
    vertical fields of view are equal for any image size.

    Args:
        *arguments: One of these lists.

    Returns:
        As `getCameraImage`.

    Raises:
        pybullet.error: Not connected, the number of arguments is wrong, or one is invalid.

    Examples:
        >>> image = p.renderImage(8, 4, [2, 0, 1], [0, 0, 0.5], [0, 0, 1], 0.1, 10)
        >>> len(image[2])
        4
    """
    if len(arguments) == 2:
        return getCameraImage(*arguments)
    if len(arguments) == 4:
        view, projection = (numbers(values, _BAD_MATRIX, "matrix") for values in arguments[2:])
        if len(view) != 16 or len(projection) != 16:
            fail(_BAD_MATRIX, "A matrix has 16 numbers.")
        return getCameraImage(*arguments)
    if len(arguments) in (7, 8):
        width, height, eye, target, up, near, far = arguments[:7]
        eye, target, up = (vector3(values, _BAD_CAMERA, "camera") for values in (eye, target, up))
        view = computeViewMatrix(eye, target, up)
        angle = arguments[7] if len(arguments) == 8 else _DEFAULT_FIELD_OF_VIEW
    elif len(arguments) == 11:
        width, height, target, distance, yaw, pitch, roll, up_axis, near, far, angle = arguments
        target = vector3(target, _BAD_TARGET, "camera target")
        view = computeViewMatrixFromYawPitchRoll(target, distance, yaw, pitch, roll, up_axis)
    else:
        fail("Invalid number of args passed to renderImage.", f"There are {len(arguments)}.")
    return getCameraImage(width, height, view, computeProjectionMatrixFOV(angle, 1.0, near, far))
