"""Tessellated primitives: closed, the right way round, of the right size."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.thorough.profiles import cases

from carom.description import Box, Capsule, Cylinder, Plane, Sphere
from carom.description.shapes.plane import DRAWN_HALF_SIZE
from carom.formats.visuals.render_mesh import face_normals
from carom.render.primitives import primitive_mesh

SIZES = st.floats(0.01, 10.0)
SOLIDS = st.one_of(
    st.builds(Sphere, SIZES),
    st.builds(Box, st.tuples(SIZES, SIZES, SIZES)),
    st.builds(Cylinder, SIZES, SIZES),
    st.builds(Capsule, SIZES, SIZES),
)


def volume_of(shape):
    match shape:
        case Sphere(r):
            return 4 / 3 * np.pi * r**3
        case Box((x, y, z)):
            return 8 * x * y * z
        case Cylinder(r, length):
            return np.pi * r**2 * length
        case Capsule(r, length):
            return 4 / 3 * np.pi * r**3 + np.pi * r**2 * length
    raise AssertionError(shape)


def corners_of(mesh):
    return mesh.positions.astype(np.float64)[mesh.triangles]


@settings(max_examples=cases(40), deadline=None)
@given(SOLIDS)
def test_solids_are_closed_and_face_outwards(shape):
    corners = corners_of(primitive_mesh(shape))
    # The signed volume of all tetrahedra to the origin is right only if no triangle is missing or turned.
    signed = np.einsum("ni,ni->n", corners[:, 0], np.cross(corners[:, 1], corners[:, 2])).sum() / 6
    assert signed == pytest.approx(volume_of(shape), rel=0.02)
    assert np.abs(
        np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]).sum(axis=0)
    ).max() < (1e-4 * np.abs(corners).max() ** 2)


@settings(max_examples=cases(40), deadline=None)
@given(SOLIDS)
def test_normals_have_unit_length_and_lean_with_their_triangles(shape):
    mesh = primitive_mesh(shape)
    assert np.linalg.norm(mesh.normals, axis=1) == pytest.approx(1.0, abs=1e-5)
    flat = face_normals(corners_of(mesh))
    assert np.einsum("nci,ni->nc", mesh.normals[mesh.triangles], flat).min() > 0.95


def test_a_ball_has_all_its_vertices_at_the_radius():
    assert np.linalg.norm(primitive_mesh(Sphere(0.7)).positions, axis=1) == pytest.approx(0.7)


def test_a_capsule_reaches_its_radius_beyond_its_length():
    positions = primitive_mesh(Capsule(0.2, 1.0)).positions
    assert positions[:, 2].max() == pytest.approx(0.7)
    assert positions[:, 2].min() == pytest.approx(-0.7)


@pytest.mark.parametrize("normal", [(0, 0, 1), (1, 0, 0), (0, -1, 0), (0.6, 0.0, 0.8), (-0.48, 0.6, 0.64)])
def test_a_plane_is_a_large_square_across_its_normal(normal):
    mesh = primitive_mesh(Plane(normal))
    assert mesh.positions @ np.array(normal) == pytest.approx(0.0, abs=1e-4)
    assert face_normals(corners_of(mesh)) == pytest.approx(np.tile(normal, (2, 1)), abs=1e-6)
    assert np.linalg.norm(mesh.positions, axis=1) == pytest.approx(DRAWN_HALF_SIZE * 2**0.5)


def test_the_same_shape_is_tessellated_once():
    assert primitive_mesh(Sphere(0.123)) is primitive_mesh(Sphere(0.123))


def test_an_image_wraps_around_a_box_in_six_equal_tiles_that_do_not_overlap():
    """As in PyBullet: each side shows a sixteenth of the image, undistorted, whatever the box's size."""
    mesh = primitive_mesh(Box((1.0, 2.0, 3.0)))
    tiles = set()
    for corners in mesh.uvs.reshape(6, 4, 2):
        low = corners.min(axis=0)
        across = corners - corners[0]
        # Corner after corner around a square of a quarter of the image, from a multiple of a quarter on.
        assert np.abs(np.diff(corners, axis=0, append=corners[:1])).sum(axis=1) == pytest.approx(0.25)
        assert np.abs(across[2]) == pytest.approx(0.25)
        assert 4.0 * low == pytest.approx(np.round(4.0 * low))
        tiles.add((*np.round(4.0 * low).astype(int).tolist(),))
    assert tiles == {(0, 0), (1, 0), (2, 0), (3, 0), (0, 1), (1, 1)}
