"""Shapes in the flat arrays: what bodies leave there and what stays when they go."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.changes import at_once
from tests.thorough.profiles import cases

from carom.description import (
    Box,
    Capsule,
    Collision,
    ConvexHull,
    Cylinder,
    Geometry,
    Heightfield,
    Mesh,
    Plane,
    Pose,
    Sphere,
    TriangleMesh,
)
from carom.description.pose import IDENTITY
from carom.description.transform import quaternion_from_rpy
from carom.errors import DescriptionError
from carom.layouts.codes import ShapeKind
from carom.layouts.flags import LoadFlags
from carom.model.body_rows import TreeRows
from carom.model.body_spec import BodySpec, LinkSpec
from carom.model.builder import WorldArrays
from carom.model.link_dynamics import LinkDynamics
from carom.model.shape_arrays import ShapeArrays

MESHES = Path(__file__).parents[1] / "formats" / "data" / "meshes"
TETRAHEDRON = np.array([(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)], float)
TRIANGLES = TriangleMesh(TETRAHEDRON, np.array([(0, 2, 1), (0, 1, 3), (0, 3, 2)], np.int32))
LANDSCAPE = Heightfield(np.arange(6.0).reshape(2, 3), (1.0, 1.0, 1.0), 2.5)
ASIDE = Pose((0.1, 0.2, 0.3), quaternion_from_rpy(0.1, 0.2, 0.3))


def body(*links: tuple[Collision, ...], fixed: bool = False, flags: int = 0) -> BodySpec:
    base, *others = [LinkSpec(f"link {j}", mass=1.0, collisions=shapes) for j, shapes in enumerate(links)]
    return BodySpec("body", base, others, fixed_base=fixed, flags=flags)


def one(geometry: Geometry, frame: Pose = IDENTITY) -> tuple[Collision, ...]:
    return (Collision(geometry, frame),)


class Scene:
    """Shapes beside the links they belong to, as a world keeps them."""

    def __init__(self) -> None:
        self.arrays = WorldArrays()
        self.shapes = ShapeArrays()
        self.bodies: list[tuple[BodySpec, TreeRows]] = []

    def add(self, spec: BodySpec) -> int:
        rows = at_once(self.arrays.append, spec, IDENTITY)
        at_once(self.shapes.append, spec, rows, [LinkDynamics.of(link) for link in (spec.base, *spec.links)])
        self.bodies.append((spec, rows))
        return rows.first["link"]

    def remove(self, index: int) -> None:
        _, rows = self.bodies.pop(index)
        at_once(self.shapes.remove, rows)
        at_once(self.arrays.remove, rows, [other for _, other in self.bodies])

    def column(self, name: str) -> np.ndarray:
        axis = name.partition("_")[0]
        count = self.shapes.filter_count if axis == "filter" else self.shapes.used[axis]
        table = self.shapes.table
        array = table.numpy[name]
        return (array[0] if table.is_per_world(name) else array)[:count]


SPECS = [
    body(one(Sphere(0.5)), one(Box((0.1, 0.2, 0.3)), ASIDE)),
    body(one(Cylinder(0.2, 0.5)), (), (*one(Capsule(0.1, 0.3)), *one(Sphere(0.1), ASIDE))),
    body(one(Mesh(MESHES / "two_boxes.obj", (1.0, 2.0, 3.0))), one(Mesh(MESHES / "wedge.stl")), fixed=True),
    body(one(TRIANGLES), one(LANDSCAPE), fixed=True, flags=int(LoadFlags.USE_SELF_COLLISION)),
    body(one(Plane()), fixed=True),
    body(()),
]


def assert_same_shapes(one: Scene, other: Scene) -> None:
    assert one.shapes.used == other.shapes.used
    for name in one.shapes.table.numpy:
        np.testing.assert_array_equal(one.column(name), other.column(name), err_msg=name)


@settings(max_examples=cases(60), deadline=None)
@given(st.lists(st.tuples(st.integers(0, len(SPECS) - 1), st.integers(0, 9)), max_size=12))
def test_bodies_that_come_and_go_leave_what_the_others_need(changes: list[tuple[int, int]]) -> None:
    scene = Scene()
    kept: list[BodySpec] = []
    for spec, goes in changes:
        scene.add(SPECS[spec])
        kept.append(SPECS[spec])
        if goes < len(kept):
            scene.remove(goes)
            del kept[goes]
    fresh = Scene()
    for spec in kept:
        fresh.add(spec)
    assert_same_shapes(scene, fresh)
    for name, array in scene.shapes.table.numpy.items():
        axis = name.partition("_")[0]
        if axis != "filter":
            assert not array[scene.shapes.used[axis] :].any(), f"{name}: freed rows are zero"


def test_primitives_keep_their_sizes_and_bullets_margins() -> None:
    scene = Scene()
    implicit = int(LoadFlags.USE_IMPLICIT_CYLINDER)
    shapes = (
        Sphere(0.5),
        Box((0.1, 0.2, 0.3)),
        Capsule(0.1, 0.6),
        Cylinder(0.2, 0.5),
        Plane((1.0, 0.0, 0.0)),
    )
    for shape in shapes:
        scene.add(body(one(shape), flags=implicit))
    assert scene.column("shape_kind").tolist() == [0, 1, 2, 3, 4]
    sizes = [(0.5, 0, 0), (0.1, 0.2, 0.3), (0.1, 0.3, 0), (0.2, 0.25, 0), (1, 0, 0)]
    np.testing.assert_array_equal(scene.column("shape_size"), sizes)
    np.testing.assert_array_equal(scene.column("shape_margin"), [0.5, 0.001, 0.1, 0.001, 0.001])
    # Half the diagonal of the bounds, times 0.02.
    reach = [0.5 * 3**0.5, 0.14**0.5, (0.01 + 0.01 + 0.16) ** 0.5, (0.04 + 0.04 + 0.0625) ** 0.5]
    np.testing.assert_allclose(scene.column("shape_breaking")[:4], [0.02 * r for r in reach], rtol=1e-12)


def test_shapes_lie_in_the_inertial_frame() -> None:
    scene = Scene()
    spec = body((*one(Box((1.0, 1.0, 1.0)), ASIDE), *one(Sphere(1.0))))
    spec.base.inertial_frame = ASIDE
    scene.add(spec)
    turned_back = [-c for c in ASIDE.orientation[:3]] + [ASIDE.orientation[3]]
    poses = scene.column("shape_pose")
    np.testing.assert_allclose(poses[0], [0, 0, 0, 0, 0, 0, 1], atol=1e-15)
    np.testing.assert_allclose(poses[1][3:], turned_back, atol=1e-15)
    np.testing.assert_allclose(np.linalg.norm(poses[1][:3]), 0.14**0.5)


def test_each_group_of_an_obj_file_is_a_hull_and_a_cylinder_of_a_file_too() -> None:
    scene = Scene()
    scene.add(SPECS[2])
    scene.add(body(one(Cylinder(0.2, 0.5))))
    assert scene.column("shape_kind").tolist() == [ShapeKind.HULL] * 4
    assert scene.column("shape_face_count").tolist() == [6, 6, 5, 34]
    assert scene.column("shape_vertex_count").tolist() == [8, 8, 6, 64]
    numpy = scene.shapes.table.numpy
    for row in range(4):
        first, count = numpy["shape_first_vertex"][row], numpy["shape_vertex_count"][row]
        vertices = numpy["vertex_position"][first : first + count]
        half, center = numpy["shape_size"][0, row], numpy["shape_center"][row]
        np.testing.assert_allclose(vertices.min(axis=0), center - half, atol=1e-12)
        np.testing.assert_allclose(vertices.max(axis=0), center + half, atol=1e-12)
        for face in range(numpy["shape_first_face"][row], numpy["shape_first_face"][row] + 3):
            corners = numpy["face_first_corner"][face] + np.arange(numpy["face_corner_count"][face])
            on_face = numpy["vertex_position"][numpy["corner_vertex"][corners]]
            *normal, offset = numpy["face_plane"][face]
            np.testing.assert_allclose(on_face @ normal, offset, atol=1e-6)
            assert (vertices @ normal <= offset + 1e-9).all()


def test_surfaces_have_what_finds_their_triangles() -> None:
    scene = Scene()
    scene.add(SPECS[3])
    assert scene.column("shape_kind").tolist() == [ShapeKind.TRIANGLES, ShapeKind.HEIGHTFIELD]
    assert scene.column("shape_columns").tolist() == [0, 3]
    assert scene.column("shape_leaf_count").tolist() == [4, 0]
    assert scene.column("shape_face_count").tolist() == [3, 4]
    assert scene.shapes.used["node"] == 8


def test_groups_and_masks_follow_from_the_base_and_the_file() -> None:
    scene = Scene()
    stated = Collision(Sphere(0.1), group=4, mask=0xFFFFFFFF)
    scene.add(body(one(Sphere(0.1)), one(Sphere(0.1)), fixed=True))
    scene.add(body(one(Sphere(0.1)), (stated,)))
    assert scene.column("link_group").tolist() == [2, 1, 1, 4]
    assert scene.column("link_mask").tolist() == [-3, -1, -1, -1]
    scene.shapes.set_group_and_mask(2, 0, 2**31)
    assert scene.column("link_group")[2] == 0
    assert scene.column("link_mask")[2] == -(2**31)


def test_only_flags_of_self_collision_reach_the_kernels() -> None:
    scene = Scene()
    flags = LoadFlags.USE_SELF_COLLISION | LoadFlags.MAINTAIN_LINK_ORDER
    scene.add(body(one(Sphere(0.1)), one(Sphere(0.1)), flags=int(flags)))
    assert scene.column("link_self_collision").tolist() == [8, 8]


def test_how_a_link_touches_can_change() -> None:
    scene = Scene()
    row = scene.add(body(one(Mesh(MESHES / "wedge.stl")), one(Box((1.0, 1.0, 1.0)), ASIDE)))
    dynamics = LinkDynamics(1.0, (1.0, 1.0, 1.0), lateral_friction=0.7, ccd_swept_sphere_radius=0.2)
    dynamics.restitution, dynamics.contact_stiffness, dynamics.contact_damping = 0.3, 1e4, 50.0
    dynamics.rolling_friction, dynamics.spinning_friction, dynamics.friction_anchor = 0.1, 0.2, True
    dynamics.collision_margin = 0.02
    scene.shapes.write_surface(row, dynamics)
    scene.shapes.write_surface(row + 1, dynamics)
    expected = {"lateral_friction": 0.7, "rolling_friction": 0.1, "spinning_friction": 0.2}
    expected |= {"restitution": 0.3, "stiffness": 1e4, "contact_damping": 50.0, "friction_anchor": 1}
    for name, value in expected.items():
        assert scene.column(f"shape_{name}").tolist() == [value, value], name
    assert scene.column("shape_ccd_radius").tolist() == [0.2, 0.2]
    # The second shape is part of a compound, whose margin it gets, too.
    assert scene.column("shape_margin").tolist() == [0.02, 0.02]


def test_breaking_distances_follow_the_engines_parameter() -> None:
    scene = Scene()
    scene.add(SPECS[0])
    before = scene.column("shape_breaking").copy()
    at_once(scene.shapes.set_breaking_fraction, 0.05)
    np.testing.assert_allclose(scene.column("shape_breaking"), before * 2.5, rtol=1e-12)
    scene.add(SPECS[0])
    np.testing.assert_allclose(scene.column("shape_breaking")[2:], before * 2.5, rtol=1e-12)


@settings(max_examples=cases(50), deadline=None)
@given(st.lists(st.tuples(st.integers(0, 8), st.integers(0, 8), st.booleans()), max_size=40))
def test_rules_for_pairs_are_sorted_and_the_last_one_counts(rules: list[tuple[int, int, bool]]) -> None:
    scene = Scene()
    for _ in range(3):
        scene.add(SPECS[1])
    expected = {}
    for a, b, enabled in rules:
        scene.shapes.filters.set(a, b, enabled=enabled)
        expected[min(a, b), max(a, b)] = int(enabled)

    def stated() -> dict[tuple[int, int], int]:
        names = ("filter_link_a", "filter_link_b", "filter_enabled")
        rows = list(zip(*(scene.column(name).tolist() for name in names), strict=True))
        assert [row[:2] for row in rows] == sorted(row[:2] for row in rows)
        return {(a, b): enabled for a, b, enabled in rows}

    assert stated() == expected
    scene.remove(1)
    moved = {0: 0, 1: 1, 2: 2, 6: 3, 7: 4, 8: 5}
    kept = {(a, b): rule for (a, b), rule in expected.items() if a in moved and b in moved}
    assert stated() == {(moved[a], moved[b]): rule for (a, b), rule in kept.items()}


def test_a_landscape_can_get_other_heights() -> None:
    scene = Scene()
    scene.add(SPECS[0])
    row = scene.add(SPECS[3]) + 1
    higher = Heightfield(LANDSCAPE.heights + 1.0, LANDSCAPE.scale, LANDSCAPE.middle)
    spec = LinkSpec("link 1", mass=1.0, collisions=one(higher))
    at_once(scene.shapes.replace_pieces, row, spec, implicit_cylinder=False)
    fresh = Scene()
    fresh.add(SPECS[0])
    fresh.add(body(one(TRIANGLES), one(higher), fixed=True, flags=int(LoadFlags.USE_SELF_COLLISION)))
    for name in ("vertex_position", "face_plane", "corner_vertex", "shape_size", "shape_center"):
        np.testing.assert_array_equal(scene.column(name), fresh.column(name), err_msg=name)
    assert scene.shapes.bounds(row).center[2] == pytest.approx(1.0)


def test_a_mesh_without_area_is_refused_and_nothing_changes() -> None:
    scene = Scene()
    scene.add(SPECS[0])
    before = dict(scene.shapes.used)
    sliver = TriangleMesh(np.zeros((3, 3)), np.array([(0, 1, 2)], np.int32))
    spec = body(one(sliver))
    rows = at_once(scene.arrays.append, spec, IDENTITY)
    with pytest.raises(DescriptionError, match="area"):
        at_once(scene.shapes.append, spec, rows, [LinkDynamics.of(spec.base)])
    assert scene.shapes.used == before


def test_hulls_of_fine_meshes_are_simplified() -> None:
    scene = Scene()
    ball = np.random.default_rng(0).normal(size=(5000, 3))
    ball /= np.linalg.norm(ball, axis=1, keepdims=True)
    scene.add(body(one(ConvexHull(ball))))
    assert scene.column("shape_vertex_count").tolist() == [512]
