"""Manifolds of rolling shapes, against the same rules written down a second time in Python."""

from dataclasses import dataclass
from math import cos, pi, sin

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.testing import assert_allclose
from tests.collision.scene import Scene, Shape, box, capsule, cylinder, hull, plane
from tests.thorough.profiles import cases

from carom.layouts.contacts import HOLDING
from carom.layouts.status import CONTACTS_WANTED

RADIUS, HALF_LENGTH, BREAKING = 0.1, 0.15, 0.004
LYING = (2**-0.5, 0.0, 0.0, 2**-0.5)
GROUNDS = {
    "plane": plane(breaking=BREAKING),
    "box": box((5, 5, 1), position=(0, 0, -1), margin=0.001, breaking=BREAKING, static=True),
}


def wheel(sides: int = 16) -> Shape:
    """A prism along z."""
    angles = 2.0 * pi * np.arange(sides) / sides
    rim = [(RADIUS * cos(a), RADIUS * sin(a), z) for a in angles for z in (-HALF_LENGTH, HALF_LENGTH)]
    return hull(rim, breaking=BREAKING)


ROLLERS = {
    "cylinder": cylinder(RADIUS, HALF_LENGTH, margin=0.001, breaking=BREAKING),
    "capsule": capsule(RADIUS, HALF_LENGTH, breaking=BREAKING),
    "wheel": wheel(),
}


def product(q, r):
    """Product of two quaternions (x, y, z, w)."""
    u, s, v, t = np.array(q[:3]), q[3], np.array(r[:3]), r[3]
    return (*(s * v + t * u + np.cross(u, v)), s * t - u @ v)


def turn(axis: int, angle: float):
    """A turn about one of the world's axes."""
    return (*(sin(angle / 2) * np.eye(3)[axis]), cos(angle / 2))


def matrix(q):
    """Rotation matrix of a quaternion."""
    x, y, z, w = q
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
        ]
    )


@dataclass
class Point:
    """A contact as the reference keeps it: its points on the roller and on the ground."""

    on_roller: np.ndarray
    on_ground: np.ndarray
    height: float


def spread(new, others) -> float:
    a, b, c = (other.on_roller for other in others)
    return float(np.sum(np.cross(new.on_roller - a, c - b) ** 2))


def reference(points: list[Point], position, frame, new: Point | None) -> list[Point]:
    """The points of the next step on ground whose upper side is z = 0."""
    points = list(points)
    if new is not None:
        away = [float(np.sum((point.on_roller - new.on_roller) ** 2)) for point in points]
        if away and min(away) < BREAKING**2:
            points[int(np.argmin(away))] = new
        elif len(points) < 4:
            points.append(new)
        else:
            heights = [point.height for point in points]
            deepest = int(np.argmin(heights)) if min(heights) < new.height else -1
            sizes = [
                -1.0 if slot == deepest else spread(new, points[:slot] + points[slot + 1 :])
                for slot in range(4)
            ]
            points[int(np.argmax(sizes))] = new
    for slot in reversed(range(len(points))):
        point = points[slot]
        offset = position + frame @ point.on_roller - point.on_ground
        point.height = float(offset[2])
        if point.height > BREAKING or float(offset[:2] @ offset[:2]) > BREAKING**2:
            points[slot] = points[-1]
            points.pop()
    return points


def new_point(roller: str, ground: str, position, orientation) -> Point | None:
    """The deepest point of the roller now: the first in which it touches."""
    scene = Scene([ROLLERS[roller], GROUNDS[ground]])
    scene.place(0, position, orientation)
    scene.collide()
    if not len(scene.contacts("distance")):
        return None
    return Point(
        scene.contacts("local_a")[0].copy(),
        scene.contacts("point_b")[0].copy(),
        float(scene.contacts("distance")[0]),
    )


steps = st.tuples(
    st.floats(-0.01, 0.01), st.floats(-0.003, 0.003), st.floats(-0.03, 0.03), st.floats(-0.002, 0.002)
)


@pytest.mark.parametrize("ground", GROUNDS)
@pytest.mark.parametrize("roller", ROLLERS)
@settings(max_examples=cases(15), deadline=None)
@given(motion=st.lists(steps, min_size=3, max_size=12))
def test_points_gather_by_the_rules(roller: str, ground: str, motion) -> None:
    """A roller that rolls, slips, tilts and hops by random little steps."""
    scene = Scene([ROLLERS[roller], GROUNDS[ground]])
    position, orientation = np.array([0.0, 0.0, RADIUS + 0.001]), LYING
    expected: list[Point] = []
    for way, rise, tilt, slip in motion:
        position = position + np.array((way, slip, 0.0))
        position[2] = RADIUS + rise
        orientation = product(turn(1, way / RADIUS), product(turn(0, tilt), orientation))
        scene.place(0, position, orientation)
        frame = matrix(orientation)
        expected = reference(expected, position, frame, new_point(roller, ground, position, orientation))
        scene.collide()
        assert_allclose(
            scene.contacts("local_a"), np.reshape([point.on_roller for point in expected], (-1, 3)), atol=1e-9
        )
        assert_allclose(
            scene.contacts("point_b"), np.reshape([point.on_ground for point in expected], (-1, 3)), atol=1e-9
        )
        assert_allclose(scene.contacts("distance"), [point.height for point in expected], atol=1e-9)
        orientation = tuple(np.array(orientation) / np.linalg.norm(orientation))


@pytest.mark.parametrize("ground", GROUNDS)
def test_a_lying_cylinder_finds_its_second_end_when_it_tilts(ground: str) -> None:
    scene = Scene([ROLLERS["cylinder"], GROUNDS[ground]])
    for tilt, count in ((1e-4, 1), (-1e-4, 2), (1e-4, 2)):
        scene.place(0, (0, 0, RADIUS), product(turn(0, tilt), LYING))
        scene.collide()
        assert len(scene.contacts("distance")) == count
    ends = np.sort(scene.contacts("point_b")[:, 1])
    assert_allclose(ends, (-HALF_LENGTH, HALF_LENGTH), atol=2e-3)


@pytest.mark.parametrize("ground", GROUNDS)
@pytest.mark.parametrize("roller", ["cylinder", "wheel"])
def test_what_stands_gathers_its_points(roller: str, ground: str) -> None:
    """What stands exactly upright touches with one point, and not in the middle."""
    scene = Scene([ROLLERS[roller], GROUNDS[ground]])
    scene.place(0, (0, 0, HALF_LENGTH))
    scene.collide()
    ((x, y, _z),) = scene.contacts("point_b")
    assert np.hypot(x, y) > 0.3 * RADIUS


@pytest.mark.parametrize("ground", GROUNDS)
@pytest.mark.parametrize("tilt", [0.01, 0.04])
def test_a_cube_that_is_a_hull_gathers_its_points(ground: str, tilt: float) -> None:
    half = 0.02
    cube = hull(
        [(x, y, z) for x in (-half, half) for y in (-half, half) for z in (-half, half)], breaking=BREAKING
    )
    scene = Scene([cube, GROUNDS[ground]])
    # Its lowest edge is 1 mm deep.
    scene.place(0, (0, 0, half * (cos(tilt) + sin(tilt)) - 0.001), turn(0, tilt))
    scene.collide()
    assert len(scene.contacts("distance")) == 1


@pytest.mark.parametrize(("ground", "counts"), [("plane", [1, 2, 3, 4]), ("box", [2, 4, 4, 4])])
def test_a_box_that_rocks_gathers_its_corners(ground: str, counts: list[int]) -> None:
    """On a plane one at a time; on a box those that touch, while those of before have not parted."""
    half = 0.05
    scene = Scene([box((half, half, half), breaking=BREAKING), GROUNDS[ground]])
    found = []
    for roll, pitch in ((2e-3, 1e-3), (-2e-3, 1e-3), (-2e-3, -1e-3), (2e-3, -1e-3)):
        # About one axis alone it touches boxes with two corners.
        orientation = product(turn(0, roll), turn(1, pitch)) if ground == "plane" else turn(0, roll)
        scene.place(0, (0, 0, half), orientation)
        scene.collide()
        found.append(len(scene.contacts("distance")))
    assert found == counts


def _boxes_at_rest(holding: bool) -> Scene:
    """Two cubes, the upper one turned by 0.2 on the lower; their contacts held before, or did not."""
    half = 0.05
    scene = Scene([box((half, half, half), breaking=BREAKING) for _ in range(2)])
    scene.place(1, (0, 0, 2 * half - 1e-5), turn(2, 0.2))
    scene.collide()
    assert len(scene.contacts("distance")) == 4
    scene.contacts("warm_start")[:] = HOLDING if holding else 1.0
    return scene


@pytest.mark.parametrize("holding", [True, False])
def test_boxes_at_rest_keep_their_points(holding: bool) -> None:
    scene = _boxes_at_rest(holding)
    places = scene.contacts("local_a").copy()
    # It leans a little the other way, so that another corner is the deepest.
    scene.place(1, (0, 0, 0.1 - 1e-5), product(turn(1, 1e-5), turn(2, 0.2)))
    scene.collide()
    stayed = np.abs(scene.contacts("local_a") - places).max() < 1e-12
    assert stayed == holding
    # A point that replaces another one does not end warm starting.
    assert scene.contacts("warm_start").min() >= 1.0


def test_boxes_at_rest_that_turn_together_get_new_normals() -> None:
    scene = _boxes_at_rest(holding=True)
    together = turn(0, 1e-3)
    for row, height in enumerate((0.0, 0.1 - 1e-5)):
        scene.place(row, matrix(together) @ (0, 0, height), product(together, turn(2, 0.2 * row)))
    scene.collide()
    assert_allclose(scene.contacts("normal"), [matrix(together) @ (0, 0, -1)] * 4, atol=1e-9)


def test_a_point_that_is_found_again_keeps_its_impulse_and_a_new_one_has_none() -> None:
    scene = Scene([ROLLERS["capsule"], GROUNDS["plane"]])
    scene.place(0, (0, 0, RADIUS), product(turn(0, 1e-4), LYING))
    scene.collide()
    scene.contacts("impulse")[:] = 3.0
    scene.place(0, (0.001, 0, RADIUS), product(turn(0, 1e-4), LYING))
    scene.collide()
    assert_allclose(scene.contacts("impulse"), [[3.0] * 3])
    scene.place(0, (0.001, 0, RADIUS), product(turn(0, -1e-4), LYING))
    scene.collide()
    assert_allclose(scene.contacts("impulse"), [[3.0] * 3, [0.0] * 3])


def test_gathered_contacts_without_room_are_found_when_there_is_and_have_lost_nothing() -> None:
    rollers = [
        Shape(**{**vars(ROLLERS["capsule"]), "position": (i, 0, RADIUS), "orientation": LYING})
        for i in range(40)
    ]
    small, large = (Scene([*rollers, GROUNDS["plane"]], contact_room=room) for room in (16, 128))
    for tilt in (1e-4, -1e-4):
        for scene in (small, large):
            for row in range(40):
                scene.place(row, (row, 0, RADIUS), product(turn(0, tilt), LYING))
            scene.collide()
        count = int(small.status[CONTACTS_WANTED])
        if count:
            small.tables["contacts"].reserve({"contact": count})
            small.grow_scratch(41, 64)
            small.collide()
        for name in ("local_a", "local_b", "distance"):
            assert_allclose(small.contacts(name), large.contacts(name), atol=0)
    assert len(small.contacts("distance")) == 80
