"""Camera images."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from math import hypot
from typing import TYPE_CHECKING, Any

from pybullet._calls.arguments import Vector, integer, numbers, quantity, vector3
from pybullet._calls.builtin import exported
from pybullet._calls.constants import (
    ER_NO_SEGMENTATION_MASK,
    ER_SEGMENTATION_MASK_OBJECT_AND_LINKINDEX,
    ER_USE_PROJECTIVE_TEXTURE,
)
from pybullet._calls.errors import fail
from pybullet._calls.optional_vectors import has_length
from pybullet._clients.clients import client_of
from pybullet._window.view import projection_of_window, square, view_of_window

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from carom.render.lights import Light

__all__ = ["getCameraImage"]

_FAILED = "getCameraImage failed."
# Shorter directions of the light have no length in floating-point numbers [m].
_MIN_LENGTH = 1e-30
_BODY_BITS = (1 << 24) - 1
_COEFFICIENTS = {
    "lightDistance": "distance",
    "lightAmbientCoeff": "ambient",
    "lightDiffuseCoeff": "diffuse",
    "lightSpecularCoeff": "specular",
}


@exported
def getCameraImage(
    width: int,
    height: int,
    viewMatrix: Vector | None = None,
    projectionMatrix: Vector | None = None,
    lightDirection: Vector | None = None,
    lightColor: Vector | None = None,
    lightDistance: float = -1,
    shadow: int = -1,
    lightAmbientCoeff: float = -1,
    lightDiffuseCoeff: float = -1,
    lightSpecularCoeff: float = -1,
    renderer: int = -1,
    flags: int = -1,
    projectiveTextureView: Vector | None = None,
    projectiveTextureProj: Vector | None = None,
    physicsClientId: int = 0,
) -> tuple[int, int, NDArray[np.uint8], NDArray[np.float32], NDArray[np.int32]]:
    """Renders a camera image of the world. Needs neither a GPU nor a display.

    Settings of the light, including shadows, also apply to later images.

    Args:
        width: Number of columns, from 1 to 16384; there may be up to 64 million pixels.
        height: Number of rows.
        viewMatrix: World to camera, 16 numbers column after column, as from `computeViewMatrix`.
        projectionMatrix: Camera to image, as from `computeProjectionMatrixFOV`. If one of the two is not
            given, the camera is that of the window, or without a window one near the origin that looks at it.
        lightDirection: Towards the light, world axes; default (-50, 30, 100).
        lightColor: Red, green and blue of the light; default (1, 1, 1).
        lightDistance: Distance of the lamp that casts shadows from the world's origin [m]; default 2. The
            shadow map is rendered from there with the camera's projection. Negative: no change.
        shadow: 1 for shadows, 0 for none; -1: no change; default none.
        lightAmbientCoeff: Ambient share of the colour, visible without light; default 0.6. Negative: no
            change.
        lightDiffuseCoeff: Diffuse share of the colour; default 0.35.
        lightSpecularCoeff: Strength of highlights; default 0.05.
        renderer: `ER_TINY_RENDERER` or `ER_BULLET_HARDWARE_OPENGL`: there is one renderer for both.
        flags: `ER_SEGMENTATION_MASK_OBJECT_AND_LINKINDEX`, `ER_NO_SEGMENTATION_MASK` and
            `ER_USE_PROJECTIVE_TEXTURE`, added up.
        projectiveTextureView: For `ER_USE_PROJECTIVE_TEXTURE`: view matrix of the projector of textures; by
            default that of the camera.
        projectiveTextureProj: Projector to the square of the texture, whose lower left corner is (0, 0).
        physicsClientId: The connection.

    Returns:
        (width, height, colours, depth, segmentation). Colours: (height, width, 4) uint8, red, green, blue,
        255, white for the background. Depth: (height, width) float32 as in OpenGL's buffer; the
        distance along the view is far * near / (far - (far - near) * depth) [m]. Segmentation:
        (height, width) int32 body ids, -1 where there is nothing; with the flag
        `ER_SEGMENTATION_MASK_OBJECT_AND_LINKINDEX` body id + (link index + 1) << 24. Row 0 is the top.

    Raises:
        pybullet.error: Not connected, the size is out of range, or a matrix, a colour or the direction of the
            light is invalid.

    Examples:
        >>> view = p.computeViewMatrix([2, 0, 1], [0, 0, 0.5], [0, 0, 1])
        >>> lens = p.computeProjectionMatrixFOV(60, 4 / 3, 0.1, 10)
        >>> width, height, colour, depth, bodies = p.getCameraImage(64, 48, view, lens)
        >>> colour.shape, depth.shape, bodies.shape
        ((48, 64, 4), (48, 64), (48, 64))
    """
    given = locals()
    client = client_of(physicsClientId)
    columns, rows = integer(width, "width"), integer(height, "height")
    options = max(integer(flags, "flags"), 0)
    integer(renderer, "renderer")
    view, projection = _matrix(viewMatrix, "viewMatrix"), _matrix(projectionMatrix, "projectionMatrix")
    if view is None or projection is None:
        view, projection = view_of_window(client), projection_of_window(client)

    from carom.native.products import product
    from carom.render.appearance import appearance_of
    from carom.render.renderer import renderer_of

    projector = None
    if options & ER_USE_PROJECTIVE_TEXTURE:
        projector = product(projection, view)
        place = _matrix(projectiveTextureView, "projectiveTextureView")
        cast = _matrix(projectiveTextureProj, "projectiveTextureProj")
        if place is not None and cast is not None:
            projector = product(cast, place)
    with client.call_lock:
        appearance = appearance_of(client.world)
        light = _changed_light(appearance.light, given)
        try:
            image = renderer_of(client.world, as_pybullet=True).draw(
                client.world, view, projection, columns, rows, light, projector
            )
        except ValueError as problem:
            fail(_FAILED, f"{str(problem)[0].upper()}{str(problem)[1:]}.")
        appearance.light = light
    label = image.label
    if options & ER_NO_SEGMENTATION_MASK:
        label.fill(-1)
    elif not options & ER_SEGMENTATION_MASK_OBJECT_AND_LINKINDEX:
        label[label >= 0] &= _BODY_BITS
    client.window.show_image(image, view, projection)
    return columns, rows, image.rgba, image.depth, label


def _matrix(values: Any, name: str) -> NDArray[np.float64] | None:
    """A matrix as from `square`; None if not given or, with a warning, without 16 items."""
    if not has_length(values, 16, name):
        return None
    return square(numbers(values, _FAILED, name))


def _changed_light(light: Light, given: Mapping[str, Any]) -> Light:
    """The light with the changes of a call's arguments; None and negative numbers stand for no change."""
    changes: dict[str, Any] = {}
    for argument, name in _COEFFICIENTS.items():
        value = quantity(given[argument], argument)
        if value >= 0.0:
            changes[name] = value
    shadow = integer(given["shadow"], "shadow")
    if has_length(given["lightDirection"], 3, "lightDirection"):
        changes["direction"] = vector3(given["lightDirection"], _FAILED, "lightDirection")
        if hypot(*changes["direction"]) < _MIN_LENGTH:
            fail(_FAILED, f"lightDirection has length {hypot(*changes['direction']):g}.")
    if has_length(given["lightColor"], 3, "lightColor"):
        changes["colour"] = vector3(given["lightColor"], _FAILED, "lightColor")
    if shadow >= 0:
        changes["shadow"] = shadow != 0
    return replace(light, **changes) if changes else light
