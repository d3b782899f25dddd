"""Rays against hulls of any number of faces, beside the same search over one plane after the other."""

from __future__ import annotations

import numpy as np
import pytest

import pybullet as p
from pybullet._clients.clients import client_of

COUNT = 300
# Numbers of corners: with faces that do and do not fill the groups of four, and with more than are looked at
# before a ray may be found to pass by.
CORNERS = (4, 5, 6, 7, 8, 9, 13, 30, 70)


def planes_of_the_only_shape(client: int) -> np.ndarray:
    """Normals and heights of the origin above the faces, moved outwards by the margin."""
    shapes = client_of(client).world.contact_arrays.shapes.table.numpy
    first, count = shapes["shape_first_face"][0], shapes["shape_face_count"][0]
    planes = shapes["face_plane"][first : first + count].copy()
    planes[:, 3] = -planes[:, 3] - shapes["shape_margin"][0, 0]
    return planes


def reference(planes: np.ndarray, start: np.ndarray, way: np.ndarray) -> tuple[float, np.ndarray] | None:
    """Fraction and normal where a ray from outside enters, or None."""
    enter, leave, normal = -1.0, 1.0, np.zeros(3)
    for *outward, offset in planes:
        height, slope = float(np.dot(outward, start)) + offset, float(np.dot(outward, way))
        if slope < 0.0:
            if -height / slope > enter:
                enter, normal = -height / slope, np.array(outward)
        elif slope > 0.0:
            leave = min(leave, -height / slope)
        elif height > 0.0:
            return None
    return (enter, normal) if 0.0 <= enter <= leave else None


@pytest.fixture
def client():
    number = p.connect(p.DIRECT)
    yield number
    p.disconnect(number)


@pytest.mark.parametrize("corners", CORNERS)
def test_rays_enter_hulls_where_all_planes_say(client: int, corners: int):
    random = np.random.default_rng(corners)
    points = random.normal(size=(corners, 3))
    points /= np.linalg.norm(points, axis=1)[:, None]
    shape = p.createCollisionShape(p.GEOM_MESH, vertices=points.tolist(), physicsClientId=client)
    p.createMultiBody(0, shape, physicsClientId=client)
    # The planes of a smaller hull come after those of this one.
    smaller = p.createCollisionShape(p.GEOM_MESH, vertices=(0.5 * points).tolist(), physicsClientId=client)
    p.createMultiBody(0, smaller, basePosition=[0, 0, 50], physicsClientId=client)
    planes = planes_of_the_only_shape(client)
    starts = random.normal(size=(COUNT, 3))
    starts *= 2.5 / np.linalg.norm(starts, axis=1)[:, None]
    ends = random.normal(size=(COUNT, 3))
    ends *= random.uniform(0.5, 3.0, size=COUNT)[:, None] / np.linalg.norm(ends, axis=1)[:, None]
    hits = p.rayTestBatch(starts.tolist(), ends.tolist(), physicsClientId=client)
    count = 0
    for start, end, (body, _, fraction, _, normal) in zip(starts, ends, hits, strict=True):
        wanted = reference(planes, start, end - start)
        assert (body >= 0) == (wanted is not None)
        if wanted is not None:
            count += 1
            assert fraction == pytest.approx(wanted[0], abs=1e-9)
            assert normal == pytest.approx(wanted[1], abs=1e-9)
    assert COUNT // 20 < count < COUNT


def test_rays_beside_a_hull_and_parallel_to_its_faces_pass_by(client: int):
    """Along a prism, within its bounds, outside the slanting face, they are parallel to all but its ends."""
    corners = [[x, y, z] for x in (-1, 1) for y, z in ((0, 0), (1, 0), (0, 1))]
    shape = p.createCollisionShape(p.GEOM_MESH, vertices=corners, physicsClientId=client)
    p.createMultiBody(0, shape, physicsClientId=client)
    places = [(0.2, 0.2), (0.45, 0.45), (0.75, 0.75), (0.9, 0.5)]
    hits = p.rayTestBatch(
        [[-3, y, z] for y, z in places], [[3, y, z] for y, z in places], physicsClientId=client
    )
    assert [hit[0] for hit in hits] == [0, 0, -1, -1]
