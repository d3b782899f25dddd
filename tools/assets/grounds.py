"""Grounds to stand on and what lies on them: rolling land, a courtyard, a stone; and hills as pictures."""

from __future__ import annotations

import numpy as np
from tools.assets.obj_mesh import ObjMesh
from tools.assets.simple_meshes import blocks, stretched
from tools.assets.textures import Colours

STONE_BOUNDS = ((-0.24635, -0.24648, -0.00062), (0.24934, 0.2492, 0.17287))
LAND_CORNER, LAND_POINTS, LAND_HEIGHT = -15.0, 30, 0.1
"""The lowest x and y of the land, a corner at every metre, and how far it rises and falls [m]."""

TABLE_POINTS = 97
"""Points along each side of a table of heights."""

TABLES = ((5.01, -0.5), (4.63, 1.38), (4.77, -1.77))
"""How far the heights of each table rise and fall, and the height in the middle, from halfway up [m]."""

HILLS_TOP, HILLS_MIDDLE = 253 / 255, 112 / 255
"""Greys of the highest point and of the middle; the lowest is black."""


def _waves(u: Colours, v: Colours) -> Colours:
    """Heights from -1 to 1 over the unit square: a few waves that cross and bend each other."""
    heights = sum(
        np.sin(2.0 * np.pi * (a * u + b * v) + 2.0 * np.sin(2.0 * np.pi * (b * u - a * v))) / (a + b)
        for a, b in ((1, 2), (2, 1), (3, 2), (2, 5))
    )
    return heights / np.abs(heights).max()


def _around_a_place_to_start(u: Colours, v: Colours, middle: float) -> Colours:
    """Heights from -1 to 1; around the middle, where robots are put, nearly level and as high as is said."""
    level = np.exp(-(((u - 0.5) ** 2 + (v - 0.5) ** 2) / 0.13**2))
    rise = (1.0 - level) * (_waves(0.5 * u, 0.5 * v) - middle)
    up, down = (1.0 - middle) / rise.max(), (1.0 + middle) / -rise.min()
    return middle + np.where(rise > 0.0, up, down) * rise


def land() -> ObjMesh:
    """Rolling land of 29 m by 29 m, z upwards."""
    count = LAND_POINTS
    row, column = np.mgrid[0:count, 0:count]
    heights = LAND_HEIGHT * _waves(column / count, row / count)
    vertices = np.column_stack(
        (LAND_CORNER + column.ravel(), LAND_CORNER + row.ravel(), heights.ravel())
    ).astype(float)
    faces: list[tuple[int, ...]] = []
    for j in range(count - 1):
        for i in range(count - 1):
            corner = j * count + i
            faces += [(corner, corner + 1, corner + count + 1), (corner, corner + count + 1, corner + count)]
    return ObjMesh(vertices, faces)


def stone() -> ObjMesh:
    """A flat stone of eight uneven corners."""
    block = blocks([((-1.0, -1.0, 0.0), (1.0, 1.0, 1.0))])
    uneven = 1.0 - 0.25 * np.random.default_rng(3).random(block.vertices.shape)
    mesh = ObjMesh(block.vertices * uneven, block.faces, decimals=5)
    return stretched(mesh, *STONE_BOUNDS)


def courtyard() -> ObjMesh:
    """The courtyard of `samurai.urdf`, y upwards: a floor, a wall round it, and a tower of three storeys."""
    low_x, high_x, low_z, high_z = -69.69, 54.84, -61.54, 59.46
    walls = [
        ((low_x, 0.0, low_z), (low_x + 1.0, 3.0, high_z)),
        ((high_x - 1.0, 0.0, low_z), (high_x, 3.0, high_z)),
        ((low_x, 0.0, low_z), (high_x, 3.0, low_z + 1.0)),
        ((low_x, 0.0, high_z - 1.0), (high_x, 3.0, high_z)),
    ]
    tower = [
        ((30.0 - half, 0.0, -half), (30.0 + half, height, half))
        for half, height in ((12.0, 10.0), (9.0, 20.0), (6.0, 30.34))
    ]
    return blocks([((low_x, -0.02, low_z), (high_x, 0.0, high_z)), *walls, *tower])


def hills() -> Colours:
    """Heights as greys: hills, in the middle a place to start from."""
    heights = _around_a_place_to_start(*_square(512), 2.0 * HILLS_MIDDLE / HILLS_TOP - 1.0)
    return np.repeat((0.5 * HILLS_TOP * (1.0 + heights))[..., None], 3, axis=2)


def hills_painted() -> Colours:
    """What `hills` look like from above: meadows below, rock and snow above, slopes in the shade."""
    height = hills()[..., 0]
    meadow, rock, snow = np.array((0.3, 0.5, 0.22)), np.array((0.5, 0.46, 0.4)), np.array((0.95, 0.95, 0.97))
    stony = np.clip((height - 0.45) / 0.15, 0.0, 1.0)[..., None]
    white = np.clip((height - 0.7) / 0.1, 0.0, 1.0)[..., None]
    slope = np.clip(1.0 + 20.0 * np.gradient(height, axis=1), 0.5, 1.3)[..., None]
    colours = (meadow * (1.0 - stony) + rock * stony) * (1.0 - white) + snow * white
    return np.clip(colours * slope, 0.0, 1.0)


def _square(size: int) -> tuple[Colours, Colours]:
    v, u = np.mgrid[0:size, 0:size]
    return (u + 0.5) / size, 1.0 - (v + 0.5) / size


def heights_text(number: int) -> str:
    """A table of heights [m] of rolling land, for a height field."""
    reach, middle = TABLES[number]
    v, u = np.mgrid[0:TABLE_POINTS, 0:TABLE_POINTS] / (TABLE_POINTS - 1)
    turns = np.rot90(_around_a_place_to_start(u, v, middle / reach), number)
    return "\n".join(",".join(f"{height:.2f}" for height in row) for row in reach * turns) + "\n"


def maze() -> Colours:
    """Walls of a maze, white on black: rows of walls with one gap each, now left, now right.

    The middle is in a passage, since robots are put there.
    """
    cells = np.zeros((15, 15))
    cells[[0, -1], :] = cells[:, [0, -1]] = 1.0
    for number, row in enumerate(range(2, 13, 2)):
        cells[row, 1:-1] = 1.0
        cells[row, 1 if number % 2 else -2] = 0.0
    walls = np.pad(np.kron(cells, np.ones((17, 17))), ((0, 1), (0, 1)), constant_values=1.0)
    return np.repeat(walls[..., None], 3, axis=2).astype(np.float64)


def steps_of_grey() -> Colours:
    """8 by 16 points, from black to white."""
    heights: Colours = np.linspace(0.0, 1.0, 128).reshape(16, 8)
    return np.repeat(heights[..., None], 3, axis=2)
