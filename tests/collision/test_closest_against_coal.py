"""Nearest distances of all pairs of convex shapes against an independent library."""

import itertools
from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose
from tests.collision.scene import (
    Scene,
    Shape,
    box,
    capsule,
    cylinder,
    height_field,
    hull,
    plane,
    sphere,
    triangles,
)

from carom.layouts.codes import ShapeKind

coal = pytest.importorskip("coal", reason="it has no wheels for Windows")

POINTS = np.random.default_rng(5).normal(size=(40, 3)) * (0.2, 0.3, 0.25)
MAKERS = {
    "sphere": lambda **at: sphere(0.3, **at),
    "box": lambda **at: box((0.2, 0.35, 0.15), margin=0.01, **at),
    "capsule": lambda **at: capsule(0.15, 0.3, **at),
    "cylinder": lambda **at: cylinder(0.25, 0.2, margin=0.01, **at),
    "hull": lambda **at: hull(POINTS, margin=0.02, **at),
    "flat box": lambda **at: box((0.4, 0.4, 0.005), margin=0.001, **at),
}


def as_coal(shape: Shape):
    """The same shape in coal: the core, swept by a ball of the margin."""
    a, b, c = np.asarray(shape.size, dtype=float).tolist()
    margin = shape.margin
    if shape.kind == ShapeKind.SPHERE:
        return coal.Sphere(a)
    if shape.kind == ShapeKind.CAPSULE:
        return coal.Capsule(a, 2 * b)
    if shape.kind == ShapeKind.BOX:
        core = coal.Box(2 * (a - margin), 2 * (b - margin), 2 * (c - margin))
    elif shape.kind == ShapeKind.CYLINDER:
        core = coal.Cylinder(a - margin, 2 * (b - margin))
    else:
        assert shape.polyhedron is not None
        points = coal.StdVec_Vec3s()
        for point in shape.polyhedron.vertices:
            points.append(point)
        core = coal.Convex.convexHull(points, False, "Qt")
    core.setSweptSphereRadius(margin)
    return core


def coal_pose(shape: Shape):
    x, y, z, w = np.asarray(shape.orientation)
    return coal.Transform3s(coal.Quaternion(w, x, y, z).toRotationMatrix(), np.array(shape.position))


def between(first, first_pose, second, second_pose) -> float:
    request = coal.DistanceRequest(True, True)
    request.gjk_tolerance = request.epa_tolerance = 1e-9
    request.gjk_max_iterations = request.epa_max_iterations = 1000
    return coal.distance(first, first_pose, second, second_pose, request, coal.DistanceResult())


def coal_distance(first: Shape, second: Shape) -> float:
    return between(as_coal(first), coal_pose(first), as_coal(second), coal_pose(second))


def random_shapes(maker, count: int, spread: float, rng) -> list[Shape]:
    shapes = []
    for _ in range(count):
        turn = rng.normal(size=4)
        shapes.append(maker(position=rng.normal(size=3) * spread, orientation=turn / np.linalg.norm(turn)))
    return shapes


KINDS = list(itertools.combinations_with_replacement(MAKERS, 2))
COUNT = 20
PAIRS = [(i, COUNT + i) for i in range(COUNT)]


@pytest.mark.parametrize(("first", "second"), KINDS)
def test_distance_of_shapes_apart(first, second):
    rng = np.random.default_rng(17)
    shapes = random_shapes(MAKERS[first], COUNT, 1.0, rng) + random_shapes(MAKERS[second], COUNT, 1.0, rng)
    expected = np.array([coal_distance(shapes[i], shapes[j]) for i, j in PAIRS])
    apart = expected > 0
    assert apart.sum() > COUNT / 2
    found = Scene(shapes).closest(PAIRS)
    assert_allclose(found[apart, 6], expected[apart], rtol=0, atol=1e-6)


@pytest.mark.parametrize(("first", "second"), KINDS)
def test_depth_of_overlapping_shapes(first, second):
    """No deeper than coal finds, which for round shapes is not always the least; and it parts the shapes."""
    rng = np.random.default_rng(18)
    shapes = random_shapes(MAKERS[first], COUNT, 0.1, rng) + random_shapes(MAKERS[second], COUNT, 0.1, rng)
    scene = Scene(shapes)
    found = scene.closest(PAIRS)
    expected = np.array([coal_distance(shapes[i], shapes[j]) for i, j in PAIRS])
    assert (expected < 0).sum() > COUNT / 2
    assert (found[:, 6] > expected - 1e-6).all()
    for i, _ in PAIRS:
        shape = shapes[i]
        scene.place(i, np.asarray(shape.position) - found[i, 3:6] * found[i, 6], shape.orientation)
    assert_allclose(scene.closest(PAIRS)[:, 6], 0, atol=2e-6)


def rounding(shape: Shape) -> float:
    """What a core is swept by; coal has spheres and capsules of their own."""
    return 0.0 if shape.kind in (ShapeKind.SPHERE, ShapeKind.CAPSULE) else shape.margin


def core_of(shape: Shape):
    """The shape and its pose in coal, not swept, which its meshes do not know."""
    core = as_coal(shape)
    core.setSweptSphereRadius(0.0)
    return core, coal_pose(shape)


BUMPS = np.random.default_rng(29).normal(size=(5, 5)) * 0.2
GRID = np.array([(0.4 * (x - 2), 0.4 * (y - 2), BUMPS[y, x]) for y in range(5) for x in range(5)])
CELLS = [x + 5 * y for y in range(4) for x in range(4)]
FACES = np.array([face for a in CELLS for face in ((a, a + 1, a + 5), (a + 1, a + 6, a + 5))])
SURFACES = {"mesh": triangles(GRID, FACES), "height field": height_field(BUMPS, (0.4, 0.4))}


@pytest.mark.parametrize("surface", SURFACES)
@pytest.mark.parametrize("name", MAKERS)
def test_distance_from_surfaces(name, surface):
    """That of the nearest of their triangles."""
    rng = np.random.default_rng(31)
    shapes = random_shapes(MAKERS[name], COUNT, 0.6, rng)
    for shape in shapes:
        shape.position = np.asarray(shape.position) + np.array((0, 0, 0.8))
    ground = coal.BVHModelOBBRSS()
    ground.beginModel(len(FACES), len(GRID))
    for corners in GRID[FACES]:
        ground.addTriangle(*corners)
    ground.endModel()
    expected = np.array(
        [between(*core_of(shape), ground, coal.Transform3s()) - rounding(shape) for shape in shapes]
    )
    apart = expected > 0
    assert apart.sum() > COUNT / 3
    found = Scene([SURFACES[surface], *shapes]).closest([(row, 0) for row in range(1, COUNT + 1)])
    assert_allclose(found[apart, 6], expected[apart], rtol=0, atol=1e-6)


@pytest.mark.parametrize("name", MAKERS)
def test_distance_from_a_plane(name):
    """That of coal's half space; boxes have sharp edges against planes."""
    rng = np.random.default_rng(37)
    shapes = random_shapes(MAKERS[name], COUNT, 1.0, rng)
    normal = np.array([0.48, -0.6, 0.64])
    floor = coal.Halfspace(normal, 0.0)
    expected = []
    for shape in shapes:
        rigid = as_coal(replace(shape, margin=0.0) if shape.kind == ShapeKind.BOX else shape)
        expected.append(between(rigid, coal_pose(shape), floor, coal.Transform3s()))
    found = Scene([plane(normal), *shapes]).closest([(row, 0) for row in range(1, COUNT + 1)])
    apart = np.array(expected) > 0
    assert apart.sum() > COUNT / 4
    assert_allclose(found[apart, 6], np.array(expected)[apart], rtol=0, atol=1e-6)
