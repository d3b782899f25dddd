"""Hulls are made once for the same points, also thousands of small ones, as of the elements of a mesh."""

from __future__ import annotations

import numpy as np

from carom.description import ConvexHull
from carom.model import shape_pieces as pieces


def hulls(count: int, seed: int) -> list[ConvexHull]:
    rng = np.random.default_rng(seed)
    return [ConvexHull(rng.uniform(-1.0, 1.0, (4, 3))) for _ in range(count)]


def test_thousands_of_small_hulls_are_kept(monkeypatch):
    made = []
    make = pieces._made_hull
    monkeypatch.setattr(pieces, "_made_hull", lambda *it: made.append(1) or make(*it))
    for _ in range(2):
        for hull in hulls(2500, 7):
            pieces.shape_pieces(hull, implicit_cylinder=False)
    assert len(made) == 2500


def test_their_vertices_are_bounded(monkeypatch):
    monkeypatch.setattr(pieces, "MAX_KEPT_VERTICES", 400)
    for hull in hulls(300, 8):
        pieces.shape_pieces(hull, implicit_cylinder=False)
    kept = sum(len(it.polyhedron.vertices) for it in pieces._hulls.values() if it.polyhedron is not None)
    assert kept == pieces._kept_vertices[0] <= 400
