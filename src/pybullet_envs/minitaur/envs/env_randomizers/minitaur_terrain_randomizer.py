"""Randomizer of the ground: blocks at random positions, or a mesh of hills."""

from __future__ import annotations

import enum
import os
from collections.abc import Sequence
from math import cos, pi, sin, sqrt
from typing import Any

import numpy as np

import pybullet
import pybullet_data
from pybullet_envs.minitaur.envs.env_randomizer_base import EnvRandomizerBase

_FIELD = (15.0, 10.0)
# Distance of the robot, at the middle of the field's width, from its rear edge; half the edge length of the
# free square around the robot.
_BEHIND, _FREE = 2.0, 1.0
_DISTANCE = 0.7
_TRIES = 30
_LENGTHS, _HEIGHTS = (0.35, 0.7), (0.025, 0.05)

Point = tuple[float, float]


class PoissonDisc2D:
    """Poisson disc sampling: random points with a minimum distance and without gaps (Bridson 2007)."""

    def __init__(
        self,
        grid_length: float,
        grid_width: float,
        min_radius: float,
        max_sample_size: int,
        np_random: Any = None,
    ) -> None:
        """Starts with one point.

        Args:
            grid_length: Length of the field [m].
            grid_width: Width of the field [m].
            min_radius: Minimum distance between two points [m].
            max_sample_size: Number of tries to place points near a point.
            np_random: Random number generator.
        """
        self._size = (grid_length, grid_width)
        self._radius = min_radius
        self._tries = max_sample_size
        self._random = np.random.default_rng() if np_random is None else np_random
        # The diagonal of a cell is the minimum distance, so that a cell contains at most one point.
        self._cell = min_radius / sqrt(2)
        self._points: dict[tuple[int, int], Point] = {}
        self._active: list[Point] = []
        self._add((self._random.uniform(0, grid_length), self._random.uniform(0, grid_width)))

    def sample(self) -> None:
        """Adds points around an active point, which is then no longer active."""
        x, y = self._active.pop()
        for _ in range(self._tries):
            away, way = self._random.uniform(self._radius, 2 * self._radius), self._random.uniform(0, 2 * pi)
            point = (x + away * cos(way), y + away * sin(way))
            if all(0 <= place < most for place, most in zip(point, self._size, strict=True)):
                self._add(point)

    def generate(self) -> list[Point]:
        """Adds points until the field is full; returns all points."""
        while self._active:
            self.sample()
        return list(self._points.values())

    def _add(self, point: Point) -> None:
        """Adds a point, unless another one is too close."""
        column, row = (int(place / self._cell) for place in point)
        near = [(column + across, row + along) for across in range(-2, 3) for along in range(-2, 3)]
        others = [self._points[cell] for cell in near if cell in self._points]
        if all(np.hypot(point[0] - x, point[1] - y) >= self._radius for x, y in others):
            self._points[column, row] = point
            self._active.append(point)


class TerrainType(enum.Enum):
    """Types of uneven ground."""

    RANDOM_BLOCKS = 1
    TRIANGLE_MESH = 2


class MinitaurTerrainRandomizer(EnvRandomizerBase):
    """Randomizer of the ground of a `MinitaurGymEnv`, at each `reset`."""

    def __init__(
        self,
        terrain_type: TerrainType = TerrainType.TRIANGLE_MESH,
        mesh_filename: str | None = None,
        mesh_scale: Sequence[float] | None = None,
    ) -> None:
        """Makes a randomizer.

        Args:
            terrain_type: Whether blocks are placed on the ground, or a mesh replaces it.
            mesh_filename: File of the mesh; by default `terrain.obj` of `pybullet_data`.
            mesh_scale: Scale of the mesh along its axes; by default (1, 1, 0.3).
        """
        self._terrain_type = terrain_type
        self._mesh = mesh_filename or os.path.join(pybullet_data.getDataPath(), "terrain.obj")
        self._mesh_scale = list(mesh_scale or (1.0, 1.0, 0.3))

    def randomize_env(self, env: Any) -> None:
        """Changes the ground."""
        if self._terrain_type is TerrainType.TRIANGLE_MESH:
            self._lay_mesh(env)
        else:
            self._lay_blocks(env)

    def _lay_mesh(self, env: Any) -> None:
        bullet = env.pybullet_client
        bullet.removeBody(env.ground_id)
        shape = bullet.createCollisionShape(
            pybullet.GEOM_MESH,
            fileName=self._mesh,
            flags=pybullet.GEOM_FORCE_CONCAVE_TRIMESH,
            meshScale=self._mesh_scale,
        )
        env.ground_id = bullet.createMultiBody(0, shape)

    def _lay_blocks(self, env: Any) -> None:
        bullet, draw = env.pybullet_client, env.np_random.uniform
        for along, across in PoissonDisc2D(*_FIELD, _DISTANCE, _TRIES, env.np_random).generate():
            x, y = along - _BEHIND, across - _FIELD[1] / 2
            if abs(x) < _FREE and abs(y) < _FREE:
                continue
            # The diagonal of a block is at most the minimum distance, so that blocks do not overlap.
            half, height = draw(*_LENGTHS) / (2 * sqrt(2)), draw(*_HEIGHTS) / 2
            shape = bullet.createCollisionShape(pybullet.GEOM_BOX, halfExtents=[half, half, height])
            bullet.createMultiBody(0, shape, basePosition=[x, y, height])
