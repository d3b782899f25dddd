"""The tools that make meshes and pictures: fields, surfaces, OBJ text, PNG bytes, collision envelopes."""

from __future__ import annotations

import struct
import zlib

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from tools.assets import simple_meshes, xarm_looks
from tools.assets.envelope import COMPOUND_MARGIN, Envelope
from tools.assets.envelope import rod as capsule_between
from tools.assets.fields import ball, blend, block, drum, rod, within, without
from tools.assets.measured import Dress, dressed
from tools.assets.obj_mesh import ObjMesh
from tools.assets.parts import Box, Capsule
from tools.assets.png import png_bytes
from tools.assets.quadrupeds import SHELL
from tools.assets.soft_shapes import teddy_mesh
from tools.assets.surface import mesh_of

from carom.description.transform import quaternion_from_rpy, rotate

ORIGIN = (0.0, 0.0, 0.0)
BOWL = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.5, 1.0), (0.5, 0.2), (0.0, 0.2)]
CLOSED_MESHES = {
    "blocks": simple_meshes.blocks([((0.0, 0.0, 0.0), (1.0, 2.0, 3.0)), ((2.0, 0.0, 0.0), (3.0, 1.0, 1.0))]),
    "globe": simple_meshes.globe(1.0, 24, 14),
    "lathe": simple_meshes.lathe(
        [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.5, 1.0), (0.5, 0.2), (0.0, 0.2)], 12
    ),
    "ring": simple_meshes.ring(0.5, 0.25, 32, 16),
    "tray": simple_meshes.tray((-1.0, -1.0, 1.0, 1.0), (-2.0, -2.0, 2.0, 2.0), (0.0, 0.5), 0.1),
}
HOUSINGS = xarm_looks.fields()


def triangles(mesh: ObjMesh) -> np.ndarray:
    fans = [(face[0], face[i], face[i + 1]) for face in mesh.faces for i in range(1, len(face) - 1)]
    return mesh.vertices[np.array(fans)]


def volume(mesh: ObjMesh) -> float:
    a, b, c = np.moveaxis(triangles(mesh), 1, 0)
    return float(np.einsum("ij,ij->", a, np.cross(b, c)) / 6.0)


def positions_merged(mesh: ObjMesh) -> list[tuple[int, ...]]:
    """Faces over distinct places: the seam of a globe is one edge, its poles one corner."""
    _, number = np.unique(np.round(mesh.vertices, 9), axis=0, return_inverse=True)
    return [tuple(int(number[i]) for i in face) for face in mesh.faces]


def assert_closed(faces: list[tuple[int, ...]]) -> None:
    """Every edge is walked once in each direction."""
    edges = [(face[i], face[(i + 1) % len(face)]) for face in faces for i in range(len(face))]
    edges = [edge for edge in edges if edge[0] != edge[1]]
    assert len(set(edges)) == len(edges)
    assert {(b, a) for a, b in edges} == set(edges)


@pytest.mark.parametrize("name", CLOSED_MESHES)
def test_simple_meshes_are_closed_and_face_outwards(name: str) -> None:
    mesh = CLOSED_MESHES[name]
    assert_closed(positions_merged(mesh))
    assert volume(mesh) > 0.0


def test_globe_has_nearly_the_volume_of_a_ball() -> None:
    assert volume(CLOSED_MESHES["globe"]) == pytest.approx(4.0 * np.pi / 3.0, rel=0.03)


def test_textured_box_has_unit_volume_and_outward_normals() -> None:
    box = simple_meshes.textured_box(("m", "m.mtl"))
    assert volume(box) == pytest.approx(1.0)
    assert box.normals is not None
    assert np.all(np.einsum("ij,ij->i", box.vertices, box.normals) == pytest.approx(0.5))


@pytest.mark.parametrize("name", HOUSINGS)
def test_housings_are_round_bodies_on_their_fields(name: str) -> None:
    field, low, high = HOUSINGS[name]
    mesh = mesh_of(field, np.array(low), np.array(high), 0.025)
    assert volume(mesh) > 1e-5
    assert mesh.normals is not None
    assert np.linalg.norm(mesh.normals, axis=1) == pytest.approx(1.0)
    assert np.quantile(np.abs(field(mesh.vertices)), 0.95) < 1e-3


def test_surface_of_a_ball_is_closed_and_exact() -> None:
    mesh = mesh_of(ball((0.1, 0.0, 0.0), 0.5), np.array((-0.4, -0.5, -0.5)), np.array((0.6, 0.5, 0.5)), 0.13)
    assert_closed(list(mesh.faces))
    assert np.linalg.norm(mesh.vertices - (0.1, 0.0, 0.0), axis=1) == pytest.approx(0.5, abs=1e-9)
    assert volume(mesh) == pytest.approx(np.pi / 6.0, rel=0.05)


def test_surface_refuses_a_body_larger_than_its_box() -> None:
    with pytest.raises(ValueError, match="reaches out"):
        mesh_of(ball(ORIGIN, 1.0), np.array((-0.5, -0.5, -0.5)), np.array((0.5, 0.5, 0.5)), 0.1)


coordinate = st.floats(-2.0, 2.0, allow_subnormal=False)


@given(x=coordinate, y=coordinate, z=coordinate)
def test_fields_measure_distances(x: float, y: float, z: float) -> None:
    point = np.array([[x, y, z]])
    beside = np.hypot(x, y)
    assert ball(ORIGIN, 0.3)(point)[0] == pytest.approx(np.linalg.norm(point) - 0.3)
    along = np.clip(z, -1.0, 1.0)
    assert rod((0, 0, -1.0), (0, 0, 1.0), 0.2)(point)[0] == pytest.approx(np.hypot(beside, z - along) - 0.2)
    sharp = np.array([beside - 0.5, abs(z) - 0.75])
    expected = np.linalg.norm(np.maximum(sharp, 0.0)) + min(sharp.max(), 0.0)
    assert drum((0, 0, -0.75), (0, 0, 0.75), 0.5, 0.0)(point)[0] == pytest.approx(expected, abs=1e-12)
    corner = np.abs(point[0]) - (0.5, 0.25, 0.125)
    expected = np.linalg.norm(np.maximum(corner, 0.0)) + min(corner.max(), 0.0)
    assert block(ORIGIN, (1.0, 0.5, 0.25), 0.0)(point)[0] == pytest.approx(expected, abs=1e-12)


@given(x=coordinate, y=coordinate, z=coordinate)
def test_blends_hold_both_bodies(x: float, y: float, z: float) -> None:
    point = np.array([[x, y, z]])
    first, second = ball(ORIGIN, 0.5), ball((0.6, 0.0, 0.0), 0.4)
    nearest = min(first(point)[0], second(point)[0])
    assert nearest - 0.05 - 1e-12 <= blend(first, second, width=0.2)(point)[0] <= nearest
    assert without(first, second)(point)[0] == max(first(point)[0], -second(point)[0])
    assert within(first, second)(point)[0] == max(first(point)[0], second(point)[0])


def test_envelope_shapes_reach_its_bounds() -> None:
    envelope = Envelope((-0.2, -0.1, -0.5), (0.3, 0.2, 0.4))
    box = envelope.box(y=(None, 0.05))
    assert isinstance(box.geometry, Box)
    assert box.geometry.size == pytest.approx((0.498, 0.149, 0.898))
    assert box.xyz == pytest.approx((0.05, -0.0245, -0.05))
    capsule = envelope.capsule("z", 0.1, x="low", y="high")
    assert isinstance(capsule.geometry, Capsule)
    assert capsule.geometry.length == pytest.approx(0.9 - 2 * COMPOUND_MARGIN - 0.2)
    assert capsule.xyz == pytest.approx((-0.099, 0.099, -0.05))
    with pytest.raises(ValueError, match="no capsule"):
        envelope.capsule("y", 0.2, x=0.0, z=0.0)


@given(rows=st.integers(1, 9), columns=st.integers(1, 9), seed=st.integers(0, 99))
def test_png_bytes_hold_the_picture(rows: int, columns: int, seed: int) -> None:
    picture = np.random.default_rng(seed).random((rows, columns, 3))
    data = png_bytes(picture)
    assert data[:8] == b"\x89PNG\r\n\x1a\n"
    assert struct.unpack(">II", data[16:24]) == (columns, rows)
    start = data.index(b"IDAT")
    (length,) = struct.unpack(">I", data[start - 4 : start])
    (checksum,) = struct.unpack(">I", data[start + 4 + length : start + 8 + length])
    assert checksum == zlib.crc32(data[start : start + 4 + length])
    pixels = np.frombuffer(zlib.decompress(data[start + 4 : start + 4 + length]), np.uint8)
    pixels = pixels.reshape(rows, 1 + 3 * columns)
    assert not pixels[:, 0].any()
    assert np.abs(pixels[:, 1:].reshape(rows, columns, 3) - 255.0 * picture).max() <= 0.5


extent = st.floats(0.01, 2.0)


@given(x=extent, y=extent, z=extent, mass=st.floats(0.1, 50.0))
def test_envelope_of_an_inertia_is_the_box_that_has_it(x: float, y: float, z: float, mass: float) -> None:
    a, b, c = (mass * (p * p + q * q) / 12.0 for p, q in ((y, z), (z, x), (x, y)))
    room = Envelope.of_inertia((1.0, 2.0, 3.0), (a, b, c), mass)
    assert room.low == pytest.approx((1.0 - x / 2.0, 2.0 - y / 2.0, 3.0 - z / 2.0), abs=1e-6)
    assert room.high == pytest.approx((1.0 + x / 2.0, 2.0 + y / 2.0, 3.0 + z / 2.0), abs=1e-6)


point = st.tuples(*[st.floats(-1.0, 1.0)] * 3)


@given(start=point, end=point)
def test_capsules_between_points_end_there(
    start: tuple[float, float, float], end: tuple[float, float, float]
) -> None:
    shape = capsule_between(start, end, 0.1)
    assert isinstance(shape.geometry, Capsule)
    half = rotate(quaternion_from_rpy(*shape.rpy), (0.0, 0.0, shape.geometry.length / 2.0))
    assert np.add(shape.xyz, half) == pytest.approx(end, abs=1e-9)
    assert np.subtract(shape.xyz, half) == pytest.approx(start, abs=1e-9)


def test_a_mesh_that_is_fitted_spans_one_unit() -> None:
    mesh = teddy_mesh()
    assert mesh.vertices.min(axis=0) == pytest.approx([-0.5] * 3)
    assert mesh.vertices.max(axis=0) == pytest.approx([0.5] * 3)
    assert volume(mesh) > 0.1


def test_a_link_that_a_dress_forgets_is_an_error() -> None:
    with pytest.raises(KeyError, match="FR_upper"):
        dressed("a1/a1.urdf", "", Dress({"trunk": SHELL, "imu*": SHELL, "*_hip": SHELL, "*shoulder": SHELL}))
