"""Meshes of several parts as one, scaled."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_array_equal

from carom.meshes.part import MeshPart
from carom.model.shape_pieces import joined_parts

CORNERS = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])


@pytest.mark.parametrize(
    ("scale", "normal"),
    [((2.0, 3.0, 1.0), 6.0), ((-2.0, 3.0, 1.0), 6.0), ((-2.0, -3.0, 1.0), 6.0), ((2.0, 3.0, -1.0), -6.0)],
)
def test_triangles_are_seen_from_the_same_side(scale, normal):
    """Of a mirrored mesh they are reversed, so that normals are mirrored with it."""
    parts = [MeshPart(CORNERS, np.array([[0, 1, 2]])), MeshPart(CORNERS + 5.0, np.array([[2, 0, 1]]))]
    vertices, triangles = joined_parts(parts, scale)
    assert_array_equal(vertices, np.concatenate([CORNERS, CORNERS + 5.0]) * scale)
    for triangle in triangles:
        a, b, c = vertices[triangle]
        assert np.cross(b - a, c - a)[2] == normal
