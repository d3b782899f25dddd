"""Random terrain: what the physics stands on, what the scan sees, and how tiles rise in difficulty."""

from __future__ import annotations

import numpy as np
import pytest

from carom import World, Worlds
from carom.vector.quadruped.terrain import KINDS, LEVELS, TILE, random_terrain


def test_rays_meet_the_ground_where_the_heights_are():
    terrain = random_terrain(3)
    world = World()
    world.load(terrain.body())
    worlds = Worlds(world, 1)
    half = terrain.half - 0.5
    points = np.random.default_rng(0).uniform(-half, half, (500, 2))
    above = np.column_stack([points, np.full(500, 5.0)])
    hits = worlds.rays(above, above - np.array([0.0, 0.0, 10.0]))
    assert (hits.bodies == 0).all()
    # Inside a cell the physics has two triangles, between which heights are interpolated here.
    off = np.abs(hits.positions[0, :, 2] - terrain.height(points))
    assert np.quantile(off, 0.5) < 0.005
    assert off.max() < 0.06


def test_between_heights_the_ground_is_interpolated():
    terrain = random_terrain(3)
    at = -terrain.half + 0.1 * np.array([[200.0, 90.0], [201.0, 90.0], [200.5, 90.0]])
    first, second, middle = terrain.height(at)
    assert (first, second) == pytest.approx(tuple(terrain.heights[90, 200:202]))
    assert middle == pytest.approx(0.5 * (first + second))
    assert terrain.height(np.array([[1e3, -1e3]]))[0] == 0.0


def test_the_first_level_is_flat_and_the_others_rise():
    terrain = random_terrain(0)
    for kind in range(len(KINDS)):
        spans = []
        for level in range(LEVELS):
            middle = terrain.centres(np.array([level]), np.array([kind]))[0]
            along = np.linspace(-0.5 * TILE + 0.05, 0.5 * TILE - 0.15, 60)
            grid = np.stack(np.meshgrid(middle[0] + along, middle[1] + along), axis=-1)
            heights = terrain.height(grid)
            spans.append(heights.max() - heights.min())
        assert spans[0] == 0.0
        assert (np.diff(spans) > 0.0).all()


def test_the_seed_decides():
    assert (random_terrain(1).heights == random_terrain(1).heights).all()
    assert (random_terrain(1).heights != random_terrain(2).heights).any()
