"""Random terrain: tiles of rising difficulty in one height field, which all worlds share."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from carom.checks import Array
from carom.description.geometry import Heightfield
from carom.description.link import Collision, ContactParameters
from carom.model.body_spec import BodySpec, LinkSpec

TILE, BORDER, CELL = 6.0, 6.0, 0.1
"""Edge of a tile, width of the flat border around all tiles, distance between heights [m]."""
LEVELS = 6
"""Rows of tiles; those of row 0 are flat."""
_CELLS = round(TILE / CELL)
_RIM = round(BORDER / CELL)
_PLATFORM = 0.8
"""Half the edge of the flat middle of a tile [m]."""
_ROUGHNESS, _STAIR, _GRADE, _BLOCK = 0.05, 0.10, 0.35, 0.10
"""In the most difficult tiles: amplitude [m], height of a stair [m], slope, and height of blocks [m]."""
_TREAD = 0.4
"""Depth of stairs [m]."""


@dataclass(frozen=True)
class Terrain:
    """Heights of the ground, with the tiles along x (levels) and y (kinds).

    Attributes:
        heights: Heights [m], (points along y, points along x); the middle is at the origin.
    """

    heights: Array

    def body(self) -> BodySpec:
        """The ground as a fixed body; its frame is that of the world."""
        field = Heightfield(self.heights, (CELL, CELL, 1.0), 0.0)
        surface = ContactParameters(lateral_friction=1.0)
        link = LinkSpec(name="terrain", collisions=(Collision(field),), contact=surface)
        return BodySpec("terrain", link, fixed_base=True)

    @property
    def half(self) -> Array:
        """Half the extent along x and y [m]."""
        rows, columns = self.heights.shape
        return 0.5 * CELL * np.array([columns - 1, rows - 1])

    def height(self, points: Array) -> Array:
        """Height of the ground at points (..., 2) [m], interpolated between the heights around them."""
        places = (points + self.half) / CELL
        rows, columns = self.heights.shape
        most = np.array([columns - 1.001, rows - 1.001])
        places = np.clip(places, 0.0, most)
        corner = places.astype(np.int64)
        across, along = (places - corner)[..., 0], (places - corner)[..., 1]
        flat, first = self.heights.reshape(-1), corner[..., 1] * columns + corner[..., 0]
        near = flat[first] * (1.0 - across) + flat[first + 1] * across
        far = flat[first + columns] * (1.0 - across) + flat[first + columns + 1] * across
        return near * (1.0 - along) + far * along

    def centres(self, levels: np.ndarray, kinds: np.ndarray) -> Array:
        """Middles of tiles [m], (n, 2)."""
        places = np.stack([levels, kinds], axis=-1)
        return np.asarray(BORDER - self.half + TILE * (places + 0.5), dtype=np.float64)


def random_terrain(seed: int) -> Terrain:
    """Terrain of `LEVELS` levels and as many kinds as `KINDS` has."""
    random = np.random.default_rng(seed)
    columns, rows = 2 * _RIM + LEVELS * _CELLS + 1, 2 * _RIM + len(KINDS) * _CELLS + 1
    heights = np.zeros((rows, columns))
    for level in range(LEVELS):
        for kind, tile in enumerate(KINDS):
            x, y = _RIM + level * _CELLS, _RIM + kind * _CELLS
            heights[y : y + _CELLS, x : x + _CELLS] = tile(random, level / (LEVELS - 1))
    return Terrain(heights)


def _rings() -> Array:
    """Distance of the points of a tile from its middle, as rings of squares [m]."""
    away = np.abs(CELL * (np.arange(_CELLS) - 0.5 * _CELLS))
    return np.maximum(away[:, None], away[None, :])


def _rough(random: np.random.Generator, difficulty: float) -> Array:
    coarse = random.uniform(-1.0, 1.0, (_CELLS // 2, _CELLS // 2))
    return difficulty * _ROUGHNESS * coarse.repeat(2, axis=0).repeat(2, axis=1)


def _slope(random: np.random.Generator, difficulty: float) -> Array:
    """A pyramid with a flat top, or a pit."""
    outwards = np.clip(0.5 * TILE - _rings(), 0.0, 0.5 * TILE - _PLATFORM)
    return random.choice([-1.0, 1.0]) * difficulty * _GRADE * outwards


def _stairs(random: np.random.Generator, difficulty: float) -> Array:
    outwards = np.clip(0.5 * TILE - _rings(), 0.0, 0.5 * TILE - _PLATFORM)
    return random.choice([-1.0, 1.0]) * difficulty * _STAIR * np.floor(outwards / _TREAD)


def _blocks(random: np.random.Generator, difficulty: float) -> Array:
    edge = round(0.5 / CELL)
    blocks = random.uniform(0.0, 1.0, (_CELLS // edge, _CELLS // edge)) * (
        random.uniform(size=(_CELLS // edge, _CELLS // edge)) < 0.4
    )
    heights = difficulty * _BLOCK * blocks.repeat(edge, axis=0).repeat(edge, axis=1)
    return np.where(_rings() < _PLATFORM, 0.0, heights)


KINDS = (_rough, _slope, _stairs, _blocks)
"""Tiles of each kind: heights [m] from a generator and the difficulty, from 0 to 1."""
