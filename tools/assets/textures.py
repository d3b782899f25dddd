"""Pictures for our meshes, drawn by formula: colours (height, width, 3) between 0 and 1, top row first."""

from __future__ import annotations

from itertools import product

import numpy as np
from numpy.typing import NDArray

Colours = NDArray[np.float64]

FLOOR_BLUE = np.array((173.0, 199.0, 239.0)) / 255.0
PALE_WOOD = np.array((0.95, 0.8, 0.6))


def _unit_square(height: int, width: int) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Coordinates (u, v) of the pixel centres, v upwards."""
    v, u = np.mgrid[0:height, 0:width]
    return (u + 0.5) / width, 1.0 - (v + 0.5) / height


def floor() -> Colours:
    """Four squares of a chessboard floor, blue where the top row begins."""
    return chessboard(2, np.ones(3), FLOOR_BLUE, 256)


def chessboard(squares: int, light: Colours, dark: Colours, size: int = 64) -> Colours:
    """A plain chessboard."""
    u, v = _unit_square(size, size)
    odd = (np.floor(u * squares) + np.floor(v * squares)) % 2 > 0
    return np.where(odd[..., None], dark, light)


def framed() -> Colours:
    """A white face that darkens softly towards its edges, so that boxes show their outline."""
    u, v = _unit_square(64, 64)
    to_edge = np.minimum(np.minimum(u, 1.0 - u), np.minimum(v, 1.0 - v))
    shade = np.where(to_edge < 0.02, 0.72, 1.0 - 0.1 * np.exp(-to_edge / 0.05))
    return np.repeat(shade[..., None], 3, axis=2)


def grass() -> Colours:
    """Mown grass: two stripes, blades of many lengths."""
    u, v = _unit_square(128, 128)
    blades = sum(
        np.sin(2.0 * np.pi * (a * u + b * v) + 3.0 * np.sin(2.0 * np.pi * (c * u - d * v))) / 4.0
        for a, b, c, d in ((31, 9, 5, 7), (-23, 17, 11, 3), (13, -37, 7, 5), (41, 29, 3, 13))
    )
    tone = np.where(u < 0.5, 0.92, 1.0) + 0.12 * blades
    return np.clip(tone[..., None] * np.array((0.36, 0.56, 0.24)), 0.0, 1.0)


def wood(colour: Colours = PALE_WOOD) -> Colours:
    """Planks with grain along u."""
    u, v = _unit_square(128, 128)
    plank = np.floor(v * 4.0)
    drift = 0.06 * np.sin(2.0 * np.pi * (u + 0.31 * plank)) + 0.02 * np.sin(
        2.0 * np.pi * (3.0 * u + 0.7 * plank)
    )
    grain = 0.5 + 0.5 * np.sin(2.0 * np.pi * (14.0 * (v + drift) + 0.43 * plank))
    fine = 0.5 + 0.5 * np.sin(2.0 * np.pi * (41.0 * (v + 0.6 * drift) + 0.17 * plank))
    tone = 0.9 + 0.02 * (plank % 2.0) - 0.05 * grain**3 - 0.03 * fine
    seam = (v * 4.0) % 1.0 < 0.03
    return np.where(seam, 0.72, tone)[..., None] * colour


def football() -> Colours:
    """A truncated icosahedron blown round, its pentagons dark, unrolled by longitude and latitude."""
    u, v = _unit_square(128, 256)
    longitude, latitude = 2.0 * np.pi * u, np.pi * (v - 0.5)
    outward = np.stack(
        (np.cos(latitude) * np.cos(longitude), np.cos(latitude) * np.sin(longitude), np.sin(latitude)),
        axis=-1,
    )
    golden = (1.0 + np.sqrt(5.0)) / 2.0
    pentagons = _cyclic(1.0, golden)
    hexagons = np.vstack((_cyclic(golden, 1.0 / golden), _signs(1.0, 1.0, 1.0)))
    # Ratio of the distances of the two kinds of face from the centre of the solid.
    to_pentagon = _directions(outward, pentagons)[..., -1] / 1.02653
    to_hexagons = _directions(outward, hexagons)
    dark = to_pentagon > to_hexagons[..., -1]
    seam = ~dark & (to_hexagons[..., -1] - np.maximum(to_hexagons[..., -2], to_pentagon) < 0.012)
    grey = np.where(dark, 0.12, np.where(seam, 0.6, 0.96))
    return np.repeat(grey[..., None], 3, axis=2)


def _directions(outward: Colours, axes: Colours) -> Colours:
    """Cosines between directions and axes, least first."""
    return np.sort(outward @ (axes / np.linalg.norm(axes, axis=1, keepdims=True)).T, axis=-1)


def _signs(*values: float) -> Colours:
    """Every choice of signs of the coordinates that are not zero."""
    choices = [(-value, value) if value else (0.0,) for value in values]
    return np.array(list(product(*choices)))


def _cyclic(a: float, b: float) -> Colours:
    """The points (0, ±a, ±b) and those with the coordinates rotated."""
    return np.vstack((_signs(0.0, a, b), _signs(a, b, 0.0), _signs(b, 0.0, a)))


def colour_grid() -> Colours:
    """A chart of hues with a light grid, to see how a mesh is unwrapped."""
    u, v = _unit_square(128, 128)
    hue = 2.0 * np.pi * np.floor(u * 8.0) / 8.0
    value = 0.55 + 0.4 * np.floor(v * 8.0) / 8.0
    channels = [0.5 + 0.35 * np.cos(hue - phase) for phase in (0.0, 2.1, 4.2)]
    colours = np.stack(channels, axis=-1) * value[..., None]
    line = ((u * 8.0) % 1.0 < 0.06) | ((v * 8.0) % 1.0 < 0.06)
    return np.where(line[..., None], 0.92, colours)
