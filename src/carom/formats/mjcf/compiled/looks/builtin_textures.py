"""Textures that MJCF makes by name: checkers, gradients and plain ones, with marks."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from carom.description.pose import Vector3
from carom.native.trigonometry import asin

_SIDES = 6
_UP, _DOWN = 2, 3
_SEED = 42


def made_texture(
    kind: str,
    width: int,
    height: int,
    first: Vector3,
    second: Vector3,
    mark: str,
    mark_colour: Vector3,
    share: float,
    *,
    is_cube: bool,
) -> NDArray[np.uint8]:
    """Texels (height, width, 3) of a texture, or (width, 6 width, 3) of the sides of a cube.

    Args:
        kind: `checker`, `gradient` or `flat`.
        width: Columns of an image.
        height: Rows of an image; sides of cubes are as high as wide.
        first: `rgb1`: of the first square, of the middle or the upper end of a gradient, and of all
            but the lower side of a plain cube.
        second: `rgb2`.
        mark: `none`, `edge`, `cross` or `random`.
        mark_colour: Of edges, crosses and dots.
        share: Of texels with a dot.
        is_cube: See above.
    """
    rows = width if is_cube else height
    sides = _SIDES if is_cube else 1
    made = {
        side: _image(kind, width, rows, first, second, side if is_cube else None)
        for side in ((0, _UP, _DOWN) if is_cube else (0,))
    }
    # The four sides around the middle are alike.
    images = [made.get(side, made[0]).copy() for side in range(sides)]
    dots = np.random.default_rng(_SEED)
    for image in images:
        if mark == "edge":
            image[[0, -1]] = mark_colour
            image[:, [0, -1]] = mark_colour
        elif mark == "cross":
            image[rows // 2] = mark_colour
            image[:, width // 2] = mark_colour
        elif mark == "random":
            image[dots.random((rows, width)) < share] = mark_colour
    texels = (255.0 * np.clip(np.concatenate(images, axis=1), 0.0, 1.0) + 0.5).astype(np.uint8)
    texels.setflags(write=False)
    return texels


def _image(
    kind: str, width: int, height: int, first: Vector3, second: Vector3, side: int | None
) -> NDArray[np.float64]:
    one, other = np.array(first), np.array(second)
    if kind == "checker":
        upper = np.arange(height)[:, None] < height // 2
        left = np.arange(width)[None, :] < width // 2
        return np.where((upper == left)[..., None], one, other)
    if kind == "flat":
        return np.tile(other if side == _DOWN else one, (height, width, 1))
    x = np.linspace(-1.0, 1.0, width)[None, :]
    y = np.linspace(-1.0, 1.0, height)[:, None]
    if side is None:
        # From the middle outwards.
        weight = _blend(1.0 - 2.0 * np.hypot(x, y))
    else:
        # The share of the first colour is by the angle over the horizon of the ray through a texel.
        height_of = {_UP: 1.0, _DOWN: -1.0}.get(side, -y)
        sine = height_of / np.sqrt(1.0 + x * x + y * y)
        weight = _blend(_angles(np.clip(sine, -1.0, 1.0)) / (0.5 * np.pi))
    return weight[..., None] * one + (1.0 - weight[..., None]) * other


def _angles(sines: NDArray[np.float64]) -> NDArray[np.float64]:
    """Angles of sines [rad], the same in all libraries; they lie on a grid with many equal ones."""
    values, places = np.unique(sines, return_inverse=True)
    return np.array([asin(value) for value in values.tolist()])[places].reshape(sines.shape)


def _blend(place: NDArray[np.float64]) -> NDArray[np.float64]:
    """Share of the first colour: 1 at a place of 1 and beyond, 0 at -1 and beyond."""
    return np.clip(0.5 + place / np.sqrt(2.0 * (1.0 + place * place)), 0.0, 1.0)
