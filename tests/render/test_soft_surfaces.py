"""Normals of soft surfaces."""

import numpy as np
from numpy.testing import assert_allclose

from carom.render.soft_surfaces import node_normals


def test_normals_are_means_over_triangles_weighted_by_area() -> None:
    nodes = np.array([[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [0.0, 3.0, 0.0], [0.0, 0.0, 4.0], [9.0, 9.0, 9.0]])
    faces = np.array([[0, 1, 2], [0, 2, 3]], dtype=np.int32)
    normals = node_normals(nodes, faces)
    both = np.array([12.0, 0.0, 6.0]) / np.hypot(12.0, 6.0)
    assert_allclose(normals[:4], [both, [0, 0, 1], both, [1, 0, 0]], atol=1e-15)
    # A node without triangles has none.
    assert_allclose(normals[4], 0.0)
