"""Every shape answers all that is asked of shapes: mass, contact, pictures, files, worlds, the drop-in."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import carom
import pybullet as p
from carom.description import Collision, Link, Robot, Visual
from carom.description.geometry import BY_GEOM, BY_MJCF, BY_TAG, BY_USD, PRIMITIVES, Primitive
from carom.formats.sdf import read_sdf
from carom.formats.urdf import read_urdf
from carom.formats.urdf_writer import urdf_text
from carom.layouts.codes import ShapeKind
from carom.model.body_spec import LinkSpec
from carom.model.bounds import shape_bounds
from carom.model.inertia import collision_margin
from carom.model.shape_pieces import shape_pieces
from carom.render.meshes import shape_mesh
from carom.render.primitives import primitive_mesh
from carom.render.pybullet_meshes import mesh_in_pybullet

# One of each, of unlike lengths.
LENGTHS = {
    "half_extents": (0.2, 0.3, 0.4),
    "radius": 0.12,
    "length": 0.5,
    "normal": (0.0, 0.0, 1.0),
    "half_axes": (0.3, 0.2, 0.4),
}
SHAPES: list[Primitive] = [
    kind(**{it.field: LENGTHS[it.field] for it in kind.parameters}) for kind in PRIMITIVES
]
BOUNDED = [shape for shape in SHAPES if not shape.is_unbounded]
COUNT = 40_000
each_shape = pytest.mark.parametrize("shape", SHAPES, ids=lambda it: type(it).__name__)
each_bounded = pytest.mark.parametrize("shape", BOUNDED, ids=lambda it: type(it).__name__)


def points_within(shape: Primitive, count: int = COUNT) -> np.ndarray:
    """Random points of a shape, by its own surface: those on the inner side of all triangles' planes."""
    half = np.array(shape.bounds(implicit_cylinder=True).half)
    points = np.random.default_rng(5).uniform(-half, half, (count, 3))
    mesh = primitive_mesh(shape, 24)
    corners = mesh.positions[mesh.triangles].astype(np.float64)
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    offsets = (normals * corners[:, 0]).sum(axis=1)
    inside = np.ones(count, bool)
    for normal, offset in zip(normals, offsets, strict=True):
        inside[inside] = points[inside] @ normal <= offset
    return points[inside]


@each_bounded
def test_volume_and_moments_are_those_of_what_is_drawn(shape: Primitive):
    points = points_within(shape)
    half = np.array(shape.bounds(implicit_cylinder=True).half)
    solid = shape.solid()
    assert solid is not None
    share = len(points) / COUNT
    assert solid.measure == pytest.approx(shape.volume(), rel=1e-12)
    assert solid.measure == pytest.approx(8.0 * half.prod() * share, rel=0.03)
    spread = (points * points).mean(axis=0)
    np.testing.assert_allclose(np.diag(solid.tensor), spread.sum() - spread, rtol=0.03)


@each_bounded
def test_bounds_are_those_of_what_is_drawn(shape: Primitive):
    half = shape.bounds(implicit_cylinder=True).half
    np.testing.assert_allclose(np.abs(shape_mesh(shape).positions).max(axis=0), half, rtol=1e-6)


@each_bounded
def test_triangles_face_outwards_and_are_closed(shape: Primitive):
    mesh = shape_mesh(shape)
    corners = mesh.positions[mesh.triangles].astype(np.float64)
    volume = np.einsum("ij,ij->", corners[:, 0], np.cross(corners[:, 1], corners[:, 2])) / 6.0
    assert volume == pytest.approx(shape.volume(), rel=0.02)
    outward = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    assert ((outward * mesh.normals[mesh.triangles].sum(axis=1)).sum(axis=1) > 0.0).all()


@each_shape
def test_the_engine_has_pieces_of_it(shape: Primitive):
    for implicit in (False, True):
        (piece,) = shape_pieces(shape, implicit_cylinder=implicit)
        assert (piece.polyhedron is None) == (piece.kind < ShapeKind.HULL)
        assert piece.margin >= 0.0
    assert mesh_in_pybullet(shape) is None or len(mesh_in_pybullet(shape).triangles)  # pyright: ignore


@each_shape
def test_scaling_by_two_doubles_its_bounds(shape: Primitive):
    once, twice = shape_bounds(shape, implicit_cylinder=True), shape.scaled((2.0, 2.0, 2.0))
    factor = 1.0 if shape.is_unbounded else 2.0
    assert shape_bounds(twice, implicit_cylinder=True).half == pytest.approx(factor * np.array(once.half))
    assert twice.lengths() == pytest.approx(2.0 * np.array(shape.lengths()))


@each_shape
def test_margins_and_pybullets_moments_are_numbers(shape: Primitive):
    bounds = shape_bounds(shape, implicit_cylinder=True)
    for implicit in (False, True):
        terms = shape.mass_terms(bounds, 0.001, implicit_cylinder=implicit)
        assert all(first.at(2.0) + second.at(2.0) >= 0.0 for first, second in terms)
    assert collision_margin(LinkSpec("one", collisions=(Collision(shape),))) >= 0.0


@each_shape
def test_urdf_and_sdf_state_it_and_are_read_back(shape: Primitive, tmp_path: Path):
    if not shape.tag:
        pytest.skip("formats lack it")
    link = Link("base", collisions=(Collision(shape),), visuals=(Visual(shape),))
    file = tmp_path / "one.urdf"
    file.write_text(urdf_text(Robot("one", (link,), ()), tmp_path))
    assert read_urdf(file).links[0].collisions[0].geometry == shape
    stated = "".join(
        f"<{it.stated}>{' '.join(map(str, numbers))}</{it.stated}>" for it, numbers in shape.stated().items()
    )
    size = "<size>1 1</size>" if shape.is_unbounded else ""
    text = (
        "<sdf version='1.6'><model name='m'><link name='l'><collision name='c'><geometry>"
        f"<{shape.tag}>{stated}{size}</{shape.tag}></geometry></collision></link></model></sdf>"
    )
    file = tmp_path / "one.sdf"
    file.write_text(text)
    (placed,) = read_sdf(file)
    assert placed.robot.links[0].collisions[0].geometry == shape


@each_shape
def test_mjcf_sizes_make_it_again(shape: Primitive):
    if shape.size_count:
        assert type(shape).of_sizes(*(*shape.sizes(), 0.0, 0.0)[:3]) == shape
        fitted = type(shape).fitted((0.2, 0.2, 0.4), by_bounds=True)
        made = type(shape).of_sizes(*fitted)
        assert made.bounds(implicit_cylinder=True).half[2] == pytest.approx(0.4)


@each_shape
def test_pybullets_numbers_and_calls(shape: Primitive):
    if not shape.geom_name:
        pytest.skip("PyBullet lacks it")
    assert getattr(p, shape.geom_name) == shape.geom
    client = p.connect(p.DIRECT)
    try:
        made = p.createCollisionShape(shape.geom, **shape.call_arguments(), physicsClientId=client)
        body = p.createMultiBody(0.0, made, physicsClientId=client)
        (data,) = p.getCollisionShapeData(body, -1, physicsClientId=client)
        expected = shape.collision_data(implicit_cylinder=True)
        assert expected is not None
        assert data[2] == expected[0]
        assert data[3] == pytest.approx(expected[1])
    finally:
        p.disconnect(client)


@each_shape
def test_a_world_has_it_and_a_saved_one_keeps_it(shape: Primitive, tmp_path: Path):
    world = carom.World()
    numbers = {} if shape.is_unbounded else {it.field: getattr(shape, it.field) for it in shape.parameters}
    # A rounded box is a box with a radius.
    body = getattr(world, f"add_{type(shape).__name__.lower().removeprefix('rounded')}")(**numbers)
    geometry = body.shapes[0].geometry
    assert geometry == shape
    if not shape.is_unbounded:
        np.testing.assert_allclose(
            body.shapes[0].size, 2.0 * np.array(shape.bounds(implicit_cylinder=True).half), rtol=1e-12
        )
    file = tmp_path / "world.carom"
    world.save(file)
    (again,) = carom.World().load_saved(file)
    assert again.shapes[0].geometry == shape


def test_names_and_numbers_are_of_one_shape_each():
    for table, name in ((BY_TAG, "tag"), (BY_MJCF, "mjcf"), (BY_USD, "usd"), (BY_GEOM, "geom")):
        assert all(getattr(kind, name) == key for key, kind in table.items())
    named = [kind for kind in PRIMITIVES if kind.tag]
    assert len(BY_TAG) == len({kind.tag for kind in named}) == len(named)
