"""Nearest distances of all pairs of convex shapes against an independent library."""

import itertools

import numpy as np
import pytest
from numpy.testing import assert_allclose
from tests.collision.scene import Scene, Shape, box, capsule, cylinder, hull, sphere

from carom.model.codes import ShapeKind

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


def coal_distance(first: Shape, second: Shape) -> float:
    request = coal.DistanceRequest(True, True)
    request.gjk_tolerance = request.epa_tolerance = 1e-9
    request.gjk_max_iterations = request.epa_max_iterations = 1000
    result = coal.DistanceResult()
    poses = []
    for shape in (first, second):
        x, y, z, w = np.asarray(shape.orientation)
        poses.append(
            coal.Transform3s(coal.Quaternion(w, x, y, z).toRotationMatrix(), np.array(shape.position))
        )
    return coal.distance(as_coal(first), poses[0], as_coal(second), poses[1], request, result)


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
