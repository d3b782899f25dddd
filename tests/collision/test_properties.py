"""What holds for every pair of shapes in every position, degenerate ones included."""

import itertools

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.testing import assert_allclose
from tests.collision.scene import Scene, box, capsule, cylinder, height_field, hull, plane, sphere, triangles
from tests.thorough.profiles import cases

RNG = np.random.default_rng(11)
POINTS = RNG.normal(size=(20, 3)) * 0.3
SOLID = {
    "sphere": lambda **at: sphere(0.3, **at),
    "box": lambda **at: box((0.2, 0.3, 0.4), margin=0.001, **at),
    "capsule": lambda **at: capsule(0.15, 0.3, **at),
    "cylinder": lambda **at: cylinder(0.25, 0.2, margin=0.001, **at),
    "hull": lambda **at: hull(POINTS, margin=0.001, **at),
}
BUMPS = RNG.normal(size=(6, 6)) * 0.2
GRID = np.stack(np.meshgrid(np.arange(6) - 2.5, np.arange(6) - 2.5), axis=-1).reshape(-1, 2)
CELLS = [(i + 6 * j, i + 1 + 6 * j, i + 6 + 6 * j, i + 7 + 6 * j) for i in range(5) for j in range(5)]
FACES = [face for a, b, c, d in CELLS for face in ((a, b, c), (b, d, c))]
GROUND = {
    "plane": plane,
    "mesh": lambda **at: triangles(np.column_stack([GRID, BUMPS.ravel()]), FACES, margin=0.001, **at),
    "height field": lambda **at: height_field(BUMPS, **at),
}
EVERY = {**SOLID, **GROUND}
PAIRS = [*itertools.combinations_with_replacement(SOLID, 2), *itertools.product(SOLID, GROUND)]

coordinates = st.floats(-1.5, 1.5)
vectors = st.tuples(coordinates, coordinates, coordinates)
# Multiples of quarter turns and of tenths, to meet parallel faces and coinciding points often.
plain_coordinates = st.integers(-5, 5).map(lambda i: i / 5)
plain_vectors = st.tuples(plain_coordinates, plain_coordinates, plain_coordinates)
quarter_turns = st.sampled_from(
    [(0, 0, 0, 1), (0.5, 0.5, 0.5, 0.5), (0, 0.5**0.5, 0, 0.5**0.5), (1, 0, 0, 0)]
)
rotations = st.one_of(
    quarter_turns,
    st.tuples(*[st.floats(-1, 1)] * 4)
    .filter(lambda q: np.linalg.norm(q) > 0.1)
    .map(lambda q: tuple(np.asarray(q) / np.linalg.norm(q))),
)
poses = st.tuples(st.one_of(vectors, plain_vectors), rotations)


def rotated(q, v):
    x, y, z, w = q
    axis = np.array([x, y, z])
    return v + 2 * np.cross(axis, np.cross(axis, v) + w * np.asarray(v))


def times(p, q):
    (a, b, c, d), (x, y, z, w) = p, q
    return (
        d * x + a * w + b * z - c * y,
        d * y - a * z + b * w + c * x,
        d * z + a * y - b * x + c * w,
        d * w - a * x - b * y - c * z,
    )


def scene_of(first, second, pose_a, pose_b) -> Scene:
    return Scene(
        [
            EVERY[first](position=pose_a[0], orientation=pose_a[1]),
            EVERY[second](position=pose_b[0], orientation=pose_b[1]),
        ]
    )


@pytest.mark.parametrize(("first", "second"), PAIRS)
@settings(max_examples=cases(8), deadline=None)
@given(pose_a=poses, pose_b=poses, motion=poses)
def test_nearest_points(first, second, pose_a, pose_b, motion):
    """They do not depend on the order or on where the world's origin is, and fit their own distance."""
    scene = scene_of(first, second, pose_a, pose_b)
    found, swapped = scene.closest([(0, 1), (1, 0)])
    assert np.isfinite(found).all()
    assert np.isfinite(swapped).all()
    assert found[7] == swapped[7] == 1
    assert_allclose(swapped[6], found[6], atol=1e-6)
    assert np.linalg.norm(found[3:6]) == pytest.approx(1.0, abs=1e-9)

    offset, turn = motion
    moved = [
        (rotated(turn, np.asarray(position)) + offset, times(turn, q)) for position, q in (pose_a, pose_b)
    ]
    elsewhere = scene_of(first, second, *moved).closest([(0, 1)])[0]
    assert_allclose(elsewhere[6], found[6], atol=1e-6)


@pytest.mark.parametrize(("first", "second"), PAIRS)
@settings(max_examples=cases(8), deadline=None)
@given(pose_a=poses, pose_b=poses, step=vectors)
def test_distance_changes_no_faster_than_a_shape_moves(first, second, pose_a, pose_b, step):
    scene = scene_of(first, second, pose_a, pose_b)
    before = scene.closest([(0, 1)])[0, 6]
    small = 0.05 * np.asarray(step)
    scene.place(0, np.asarray(pose_a[0]) + small, pose_a[1])
    after = scene.closest([(0, 1)])[0, 6]
    if min(before, after) > 0 or first != "sphere":
        assert abs(after - before) <= np.linalg.norm(small) + 1e-6


@pytest.mark.parametrize(("first", "second"), PAIRS)
def test_contacts_of_a_thousand_poses_make_sense(first, second):
    rng = np.random.default_rng(7)
    scene = scene_of(first, second, ((0, 0, 0), (0, 0, 0, 1)), ((0, 0, 0), (0, 0, 0, 1)))
    count = 0
    for _ in range(100):
        turn = rng.normal(size=4)
        scene.numpy("contacts")["count_contacts"][:] = 0
        scene.place(0, rng.normal(size=3) * 0.4, turn / np.linalg.norm(turn))
        scene.collide()
        distance = scene.contacts("distance")
        normal = scene.contacts("normal")
        assert len(distance) <= 4
        assert (distance <= 0.02).all()
        assert (np.abs(np.linalg.norm(normal, axis=1) - 1) < 1e-9).all()
        gap = scene.contacts("point_a") - scene.contacts("point_b") - normal * distance[:, None]
        assert (np.abs(gap) < 1e-12).all()
        count += len(distance)
    assert count > 30


@pytest.mark.parametrize("sides", [16, 32])
def test_the_deepest_point_of_a_wheel_sunk_into_a_large_floor_is_below_it(sides):
    """The floor's face is two triangles for the algorithm, and only one of them has the point."""
    angles = 0.1 + 2 * np.pi * np.arange(sides) / sides
    rim = [(np.cos(a), np.sin(a), z) for a in angles for z in (-0.3, 0.3)]
    rng = np.random.default_rng(7)
    floor = box((100, 100, 5), position=(0, 0, -5), margin=0.001)
    wheels = [
        hull(rim, margin=0.001, position=(x, y, z), orientation=turn / np.linalg.norm(turn))
        for x, y, z, turn in zip(
            rng.uniform(-50, 50, 60), rng.uniform(-50, 50, 60), rng.uniform(0.0, 0.4, 60),
            rng.normal(size=(60, 4)), strict=True,
        )
    ]  # fmt: skip
    scene = Scene([floor, *wheels])
    for row, wheel in enumerate(wheels, start=1):
        x, y, z, *normal, distance, within = scene.closest([(row, 0)])[0]
        assert within
        assert_allclose(normal, (0, 0, 1), atol=1e-7)
        corners = np.array([rotated(wheel.orientation, np.array(corner)) for corner in rim]) + wheel.position
        assert_allclose(z, 0, atol=1e-6)
        assert_allclose(distance, corners[:, 2].min() - 0.001, atol=1e-6)
        lowest = corners[corners[:, 2] < corners[:, 2].min() + 1e-6]
        assert np.linalg.norm(lowest[:, :2] - (x, y), axis=1).min() < 1e-3
