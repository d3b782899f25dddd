"""Triangle surfaces, landscapes and the boxes around their triangles."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.thorough.profiles import cases

from carom.geometry.heightfield import heightfield_surface
from carom.geometry.polyhedron import polyhedron_of_triangles
from carom.geometry.triangle_hierarchy import triangle_hierarchy


def test_equal_vertices_become_one_and_triangles_without_area_vanish() -> None:
    vertices = np.array(
        [(0, 0, 0), (1, 0, 0), (0, 1, 0), (1, 0, 0), (0, 1, 0), (1, 1, 0), (0.5, 0, 0)], float
    )
    triangles = np.array([(0, 1, 2), (3, 5, 4), (0, 6, 1), (2, 4, 2)])
    surface = polyhedron_of_triangles(vertices, triangles)
    assert len(surface.vertices) == 4
    np.testing.assert_allclose(surface.planes, [(0, 0, 1, 0)] * 2, atol=1e-15)
    # The shared edge is shared.
    assert len(set(surface.corners.tolist())) == 4


@settings(max_examples=cases(60), deadline=None)
@given(st.integers(0, 10_000), st.integers(1, 70))
def test_every_box_of_the_hierarchy_holds_what_is_below_it(seed: int, count: int) -> None:
    rng = np.random.default_rng(seed)
    vertices = rng.normal(size=(3 * count, 3))
    surface = polyhedron_of_triangles(vertices, np.arange(3 * count).reshape(-1, 3))
    hierarchy = triangle_hierarchy(surface)
    assert hierarchy.leaf_count >= count > hierarchy.leaf_count // 2
    corners = hierarchy.surface.vertices[hierarchy.surface.corners].reshape(-1, 3, 3)
    assert {tuple(sorted(map(tuple, t))) for t in corners.tolist()} == {
        tuple(sorted(map(tuple, t))) for t in vertices.reshape(-1, 3, 3).tolist()
    }
    for leaf in range(hierarchy.leaf_count):
        node = hierarchy.leaf_count + leaf
        if leaf >= count:
            assert (hierarchy.lower[node] > hierarchy.upper[node]).all()
            continue
        np.testing.assert_array_equal(hierarchy.lower[node], corners[leaf].min(axis=0))
        np.testing.assert_array_equal(hierarchy.upper[node], corners[leaf].max(axis=0))
    for node in range(1, hierarchy.leaf_count):
        np.testing.assert_array_equal(
            hierarchy.lower[node], hierarchy.lower[2 * node : 2 * node + 2].min(axis=0)
        )
        np.testing.assert_array_equal(
            hierarchy.upper[node], hierarchy.upper[2 * node : 2 * node + 2].max(axis=0)
        )
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    np.testing.assert_allclose(hierarchy.surface.planes[:, :3], normals, atol=1e-9)


def test_the_hierarchy_of_a_sheet_is_tight() -> None:
    surface = heightfield_surface(np.zeros((17, 17)), (1.0, 1.0, 1.0), 0.0)
    hierarchy = triangle_hierarchy(surface)
    areas = np.prod(hierarchy.upper[:, :2] - hierarchy.lower[:, :2], axis=1)
    for level in range(1, 9):
        total = areas[2**level : 2 ** (level + 1)].sum()
        assert total == pytest.approx(256.0, rel=0.15), "boxes of one level hardly overlap"


@pytest.mark.parametrize("scale", [(0.5, 2.0, 3.0), (-0.5, 2.0, 3.0), (0.5, 2.0, -3.0), (-0.5, -2.0, 3.0)])
def test_a_landscape_is_centred_and_faces_up(scale: tuple[float, float, float]) -> None:
    heights = np.arange(12.0).reshape(3, 4) ** 1.5
    surface = heightfield_surface(heights, scale, 0.5 * float(heights.max()))
    assert len(surface.planes) == 2 * 2 * 3
    assert (surface.planes[:, 2] > 0.0).all()
    low, high = surface.bounds()
    np.testing.assert_allclose(low + high, 0.0, atol=1e-12)
    # The grid point (x 1, y 2).
    np.testing.assert_allclose(
        surface.vertices[1 + 4 * 2],
        (scale[0] * (1 - 1.5), scale[1] * (2 - 1.0), scale[2] * (heights[2, 1] - 0.5 * heights.max())),
    )
    cell = surface.corners.reshape(-1, 3)[:2]
    assert set(cell[0]) == {0, 1, 4}
    assert set(cell[1]) == {1, 5, 4}
