"""Hulls that keep all their vertices: searches from vertex to vertex, and faces of one direction."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import carom
from carom.description import ConvexHull
from carom.geometry.hull import convex_hull
from carom.geometry.hull_graph import CLIMBED, packed_graph, rows_of_graph, spread_first
from carom.geometry.joined_faces import joined_by_direction


def points_of(seed: int, count: int) -> np.ndarray:
    points = np.random.default_rng(seed).normal(size=(count, 3))
    return points / np.linalg.norm(points, axis=1)[:, None] * (0.3, 0.2, 0.1)


def entries(graph: np.ndarray, count: int, vertex: int) -> tuple[list[int], list[int]]:
    """Neighbours and faces of a vertex."""
    flat = graph.ravel().astype(int)
    begin, middle, end = flat[2 * vertex : 2 * vertex + 3]
    assert begin > 2 * count
    return flat[begin:middle].tolist(), flat[middle:end].tolist()


@settings(deadline=None, max_examples=20)
@given(st.integers(0, 10_000), st.integers(CLIMBED + 1, 300))
def test_climbing_ends_at_the_farthest_vertex(seed: int, count: int) -> None:
    fine = convex_hull(points_of(seed, count), coplanar=0.0)
    fine, joined = spread_first(fine, joined_by_direction(fine))
    graph = packed_graph(fine, joined)
    total = len(fine.vertices)
    assert rows_of_graph(np.concatenate([fine.vertices, graph]), total) == len(graph)
    directions = np.random.default_rng(seed + 1).normal(size=(20, 3))
    for direction in directions:
        heights = fine.vertices @ direction
        best = 0
        while True:
            beside, _ = entries(graph, total, best)
            higher = max(beside, key=lambda vertex: heights[vertex])
            if heights[higher] <= heights[best]:
                break
            best = higher
        assert heights[best] == pytest.approx(heights.max(), abs=1e-12)


def test_faces_at_a_vertex_have_it_as_a_corner() -> None:
    fine = convex_hull(points_of(3, 200), coplanar=0.0)
    fine, joined = spread_first(fine, joined_by_direction(fine))
    graph = packed_graph(fine, joined)
    for vertex in range(len(fine.vertices)):
        expected = [
            face
            for face, (first, corners) in enumerate(
                zip(joined.first_corner, joined.corner_count, strict=True)
            )
            if vertex in joined.corners[first : first + corners]
        ]
        assert sorted(entries(graph, len(fine.vertices), vertex)[1]) == expected


def test_faces_of_nearly_one_direction_are_one() -> None:
    # A block whose lower side bulges by 2e-7 of its width.
    corners = [(x, y, z) for x in (0.0, 1.0) for y in (0.0, 1.0) for z in (0.0, 1.0)]
    block = convex_hull(np.array([*corners, (0.4, 0.4, -2e-7)]), coplanar=0.0)
    joined = joined_by_direction(block)
    assert len(block.planes) > 6
    assert len(joined.planes) == 6
    assert sorted(joined.corner_count) == [4] * 6
    # The vertex within is kept.
    assert len(joined.vertices) == 9


def test_a_ring_of_faces_around_another_stays_as_it_is() -> None:
    # Around a flat top of another direction there is a crown of faces, all of one azimuth and polar angle.
    angles = np.linspace(0.0, 2.0 * np.pi, 7)[:-1]
    rings = [
        (radius * np.cos(angle), radius * np.sin(angle), height)
        for radius, height in ((1.0, 0.0), (0.5, 1e-4), (0.0, -1.0))
        for angle in angles
    ]
    solid = convex_hull(np.array(rings), coplanar=0.0)
    joined = joined_by_direction(solid)
    loops = [
        joined.corners[first : first + count].tolist()
        for first, count in zip(joined.first_corner, joined.corner_count, strict=True)
    ]
    edges = [edge for loop in loops for edge in pairwise([*loop, loop[0]])]
    assert len(edges) == len(set(edges))
    assert {(b, a) for a, b in edges} == set(edges)


@pytest.mark.parametrize("law", ["compliant", "rigid", "bullet"])
def test_a_fine_mesh_rests_as_its_ellipsoid(law: str) -> None:
    text = " ".join(f"{number:.9f}" for number in points_of(1, 4000).ravel())
    world = carom.World(gravity=(0.0, 0.0, -9.81), contact=law)
    world.load(
        f'<mujoco><asset><mesh name="m" vertex="{text}"/></asset><worldbody><geom type="plane" size="1 1 1"/>'
        '<body name="a" pos="0 0 .102"><freejoint/><geom type="mesh" mesh="m"/></body></worldbody></mujoco>'
    )
    geometry = world["a"].shapes[0].geometry
    assert isinstance(geometry, ConvexHull)
    assert geometry.keeps_all
    world.step(300)
    assert world["a"].pose.position[2] == pytest.approx(0.1, abs=2e-3)
    nearest = world.nearest(world["a"], world.bodies[0], 1.0)
    assert nearest[0].distance == pytest.approx(0.0, abs=2e-3)
