"""The order of corners of hulls: which axes it goes by, and room for edges."""

from __future__ import annotations

from itertools import product

import numpy as np

from carom.geometry import corner_order
from carom.geometry.corner_order import Grid


def test_axes_go_by_the_extent_and_those_of_equal_extent_by_their_order():
    """As in PyBullet, where a cube is as long along x as along y: x counts as the longer one."""
    for extent in product((1.0, 2.0, 3.0), repeat=3):
        points = np.array([(0.0, 0.0, 0.0), extent]) - np.array((5.0, -7.0, 1.0))
        between, greatest, least = Grid(points).axes()
        assert [greatest, between, least] == sorted(range(3), key=lambda axis: -extent[axis]), extent
    assert sorted(Grid(np.array([(0.0, 0.0, 0.0), (0.0, 0.0, 1.0)])).axes()) == [0, 1, 2]


def test_where_edges_need_more_room_the_order_is_the_same(monkeypatch):
    points = np.random.default_rng(0).normal(size=(60, 3))
    points /= np.linalg.norm(points, axis=1, keepdims=True)
    with_room = corner_order.corner_order(points, Grid(points))
    monkeypatch.setattr(corner_order, "_SPOKES_PER_POINT", 1)
    without = corner_order.corner_order(points, Grid(points))
    assert len(with_room[0]) == 60
    for found, wanted in zip(without, with_room, strict=True):
        assert found.tolist() == wanted.tolist()
