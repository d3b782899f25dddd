"""Contact points of shapes at rest and in plain positions, and what persists from step to step."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from tests.collision.scene import Scene, box, capsule, cylinder, hull, plane, sphere

from carom.layouts.codes import Part
from carom.layouts.status import CONTACTS_WANTED, OVERFLOW, PAIRS_WANTED, STATUS

CUBE = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]) * 0.5
SLAB = box((5, 5, 5), position=(0, 0, -5), static=True)
UPRIGHT_X = (0, np.sqrt(0.5), 0, np.sqrt(0.5))
UPRIGHT_Y = (np.sqrt(0.5), 0, 0, np.sqrt(0.5))


def turned(angle, axis=(0, 0, 1)):
    """Quaternion of a rotation."""
    axis = np.asarray(axis) / np.linalg.norm(axis)
    return (*(axis * np.sin(angle / 2)), np.cos(angle / 2))


def product(first, second):
    """Quaternion of the second turn, then the first."""
    u, s, v, t = np.array(first[:3]), first[3], np.array(second[:3]), second[3]
    return (*(s * v + t * u + np.cross(u, v)), s * t - u @ v)


def sorted_rows(points):
    return np.array(sorted(np.round(points, 9).tolist()))


def collided(*shapes):
    scene = Scene(shapes)
    scene.collide()
    return scene


def four_corners(half, height):
    return [[-half, -half, height], [-half, half, height], [half, -half, height], [half, half, height]]


def test_a_box_at_rest_has_its_four_corners_at_once():
    scene = collided(box((0.5, 0.5, 0.5), position=(0, 0, 0.499)), SLAB)
    assert_allclose(sorted_rows(scene.contacts("point_b")), four_corners(0.5, 0.0), atol=1e-7)
    assert_allclose(scene.contacts("distance"), -0.001, atol=1e-9)
    assert_allclose(scene.contacts("normal"), [[0, 0, 1]] * 4, atol=1e-7)


@pytest.mark.parametrize("margin", [0.0, 0.01])
def test_a_cube_that_is_a_hull_begins_with_one_point(margin):
    scene = collided(hull(CUBE, margin=margin, position=(0, 0, 0.499 + margin)), SLAB)
    ((x, y, z),) = scene.contacts("point_b")
    assert max(abs(x), abs(y)) <= 0.5 + 1e-7
    assert_allclose(z, 0, atol=1e-9)
    assert_allclose(scene.contacts("distance"), [-0.001], atol=1e-9)
    assert_allclose(scene.contacts("normal"), [[0, 0, 1]], atol=1e-7)


def test_points_are_on_the_surfaces_along_the_normal():
    scene = collided(sphere(0.5, position=(0, 0, 0.49)), box((1, 1, 1), position=(0, 0, -1)))
    assert_allclose(scene.contacts("normal"), [[0, 0, 1]])
    assert_allclose(scene.contacts("point_a"), [[0, 0, -0.01]], atol=1e-12)
    assert_allclose(scene.contacts("point_b"), [[0, 0, 0]], atol=1e-12)
    assert_allclose(scene.contacts("local_a"), [[0, 0, -0.5]], atol=1e-12)
    assert_allclose(scene.contacts("local_b"), [[0, 0, 1]], atol=1e-12)
    assert scene.contacts("shapes").tolist() == [[0, 1, 0, 1]]


def test_stacked_boxes_touch_in_the_overlap_of_their_faces():
    scene = collided(
        box((1, 1, 1)), box((1, 1, 1), position=(0.5, 0.25, 1.999), orientation=turned(np.pi / 2))
    )
    points = sorted_rows(scene.contacts("point_b")[:, :2])
    assert_allclose(points, [[-0.5, -0.75], [-0.5, 1], [1, -0.75], [1, 1]], atol=1e-9)


def test_a_box_turned_on_another_keeps_four_of_eight_points_that_span_the_overlap():
    scene = collided(
        box((0.5, 0.5, 0.5)), box((0.5, 0.5, 0.5), position=(0, 0, 0.999), orientation=turned(np.pi / 4))
    )
    points = scene.contacts("point_b")
    assert len(points) == 4
    x, y = points[:, :2].T
    order = np.argsort(np.arctan2(y, x))
    x, y = x[order], y[order]
    area = 0.5 * np.abs(x @ np.roll(y, -1) - y @ np.roll(x, -1))
    # An octagon of this size has an area of 0.83; half of it spans a quadrilateral of 0.59 at most.
    assert area > 0.55


def test_of_the_corners_of_two_boxes_the_deepest_stays():
    turn = product(turned(0.002, (1, 0.3, 0)), turned(np.pi / 4))
    scene = collided(box((0.5, 0.5, 0.5)), box((0.5, 0.5, 0.5), position=(0, 0, 0.997), orientation=turn))
    points, distances = scene.contacts("point_b"), scene.contacts("distance")
    assert len(points) == 4
    # The upper box leans down where y is least; the first to be kept is the deepest.
    assert np.argmin(distances) == 0
    assert_allclose(points[0, 1], -0.5, atol=1e-4)
    # The others are a quarter, half and three quarters around from it.
    angles = np.arctan2(points[:, 1], points[:, 0])
    assert_allclose(np.cos(angles - angles[0] - np.arange(4) * np.pi / 2), 1.0, atol=0.1)


def test_crossed_box_edges_touch_in_one_point():
    first = box((2, 0.5, 0.5), orientation=turned(np.pi / 4, (1, 0, 0)))
    height = 2 * np.sqrt(0.5) - 0.001
    second = box((0.5, 2, 0.5), position=(0, 0, height), orientation=turned(np.pi / 4, (0, 1, 0)))
    scene = collided(first, second)
    # Edges count as deeper by 1e-5 times the half widths of both boxes, as in PyBullet.
    assert_allclose(scene.contacts("distance"), [-0.00102], atol=1e-9)
    assert_allclose(scene.contacts("point_a"), [[0, 0, np.sqrt(0.5) + 2e-5]], atol=1e-9)
    assert_allclose(scene.contacts("normal"), [[0, 0, -1]], atol=1e-9)


@pytest.mark.parametrize(
    ("shape", "reach"),
    [
        (sphere(0.5, position=(0, 0, 0.5)), (0, 0)),
        (capsule(0.5, 1, position=(0, 0, 0.5), orientation=UPRIGHT_X), (1, 0)),
        (cylinder(0.5, 1, position=(0, 0, 0.5), orientation=UPRIGHT_X), (1, 0)),
        (cylinder(0.5, 1, position=(0, 0, 1)), (0.5, 0.5)),
    ],
    ids=["ball", "capsule", "lying cylinder", "standing cylinder"],
)
@pytest.mark.parametrize(
    "ground",
    [SLAB, hull(10 * CUBE - (0, 0, 5), static=True)],
    ids=["box", "hull"],
)
def test_round_shapes_that_come_down_touch_in_one_of_their_lowest_points(shape, reach, ground):
    scene = collided(shape, ground)
    assert_allclose(scene.contacts("distance"), [0], atol=1e-7)
    ((x, y, _z),) = scene.contacts("point_b")
    # On a round side the search ends where it finds no point deeper by more than rounding.
    assert abs(x) <= reach[0] + 1e-4
    assert abs(y) <= reach[1] + 1e-4
    assert_allclose(scene.contacts("normal"), [[0, 0, 1]], atol=1e-6)


def test_capsules_side_by_side_touch_where_both_are():
    scene = collided(capsule(0.5, 1), capsule(0.5, 1, position=(0.99, 0, 0.5)))
    ((x, y, z),) = scene.contacts("point_a")
    assert_allclose((x, y), (0.5, 0), atol=1e-12)
    assert -0.5 <= z <= 1


def test_impulses_follow_a_sliding_contact():
    scene = Scene([SLAB, box((0.5, 0.5, 0.5), position=(0, 0, 0.5))])
    scene.collide()
    impulses = np.arange(12.0).reshape(4, 3)
    scene.contacts("impulse")[:] = impulses
    scene.contacts("warm_start")[:] = impulses[:, 0]
    before = scene.contacts("point_b").copy()
    scene.place(1, (0.005, 0.001, 0.5))
    scene.collide()
    for point, impulse in zip(scene.contacts("point_b"), scene.contacts("impulse"), strict=True):
        match = np.argmin(np.linalg.norm(before - point, axis=1))
        assert_allclose(impulse, impulses[match])
    assert_allclose(scene.contacts("warm_start"), scene.contacts("impulse")[:, 0])


@pytest.mark.parametrize(("far", "kept"), [(0.01, [1.0]), (0.05, [1.0, 0.0])])
def test_impulses_stay_behind_where_a_contact_is_elsewhere_on_both_bodies(far, kept):
    scene = Scene([plane(), sphere(0.5, position=(0, 0, 0.5))])
    scene.collide()
    scene.contacts("impulse")[:] = 1.0
    scene.place(1, (far, 0, 0.5), turned(far / 0.5, (0, 1, 0)))
    scene.collide()
    assert_allclose(scene.contacts("impulse"), [[impulse] * 3 for impulse in kept])


def test_a_new_contact_starts_from_nothing():
    scene = Scene([SLAB, box((0.5, 0.5, 0.5), position=(0, 0, 0.5))])
    scene.collide()
    scene.contacts("impulse")[:] = 1.0
    scene.place(1, (0, 0, 2.0))
    scene.collide()
    assert len(scene.contacts("impulse")) == 0
    scene.place(1, (0, 0, 0.5))
    scene.collide()
    assert_allclose(scene.contacts("impulse"), [[0.0] * 3] * 4)


@pytest.mark.parametrize(
    ("shapes", "expected"),
    [
        ([plane(), sphere(0.5, position=(0, 0, 0.51))], 1),
        ([plane(), sphere(0.5, position=(0, 0, 0.53))], 0),
        ([sphere(0.5), sphere(0.5, position=(1.001, 0, 0))], 0),
        ([sphere(0.5), sphere(0.5, position=(0.999, 0, 0))], 1),
        ([box((0.5, 0.5, 0.5)), box((0.5, 0.5, 0.5), position=(0, 0, 1.001))], 0),
        ([box((0.5, 0.5, 0.5)), box((0.5, 0.5, 0.5), position=(0, 0, 0.999))], 4),
        ([capsule(0.5, 1), capsule(0.5, 1, position=(1.01, 0, 0))], 1),
    ],
    ids=["ball near", "ball far", "balls near", "balls touch", "boxes near", "boxes touch", "capsules near"],
)
def test_how_near_is_a_contact(shapes, expected):
    assert len(collided(*shapes).contacts("distance")) == expected


def test_boxes_that_touched_stay_in_contact_up_to_the_breaking_distance():
    scene = Scene([box((0.5, 0.5, 0.5)), box((0.5, 0.5, 0.5), position=(0, 0, 0.999))])
    scene.collide()
    scene.place(1, (0, 0, 1.01))
    scene.collide()
    assert_allclose(scene.contacts("distance"), [0.01] * 4, atol=1e-12)
    scene.place(1, (0, 0, 1.03))
    scene.collide()
    assert len(scene.contacts("distance")) == 0


def test_parts_of_a_compound_make_contacts_only_where_their_bounds_meet():
    scene = Scene([box((0.5, 0.5, 0.5)), sphere(0.5, position=(0, 0, 1.01))])
    scene.collide()
    assert len(scene.contacts("distance")) == 1
    scene.numpy("shapes")["shape_part"][1] = Part.OTHER
    scene.collide()
    assert len(scene.contacts("distance")) == 0
    scene.place(1, (0, 0, 0.9999))
    scene.collide()
    assert len(scene.contacts("distance")) == 1


def test_parts_of_a_compound_always_meet_the_bounds_of_a_plane():
    scene = Scene([plane(), sphere(0.5, position=(0, 0, 0.51))])
    scene.numpy("shapes")["shape_part"][1] = Part.OTHER
    scene.collide()
    assert len(scene.contacts("distance")) == 1
    scene.place(1, (0, 0, 0.5201))
    scene.collide()
    assert len(scene.contacts("distance")) == 0


def test_contacts_without_room_are_found_when_there_is_and_have_lost_nothing():
    slab = box((50, 50, 5), position=(0, 0, -5), static=True)
    shapes = [slab, *(box((0.5, 0.5, 0.5), position=(2 * i, 0, 0.5)) for i in range(8))]
    scene = Scene(shapes, contact_room=16)
    for i in range(1, 9):
        scene.place(i, (2 * i, 0, 0.5 if i == 3 else 5.0))
    scene.collide()
    scene.contacts("impulse")[:] = 7.0
    for i in range(1, 9):
        scene.place(i, (2 * i, 0, 0.5))
    scene.collide()
    for _ in range(2):
        assert scene.status[[STATUS, CONTACTS_WANTED]].tolist() == [OVERFLOW, 32]
        assert len(scene.contacts("impulse")) == 4
        assert_allclose(scene.contacts("impulse"), 7.0)
        scene.collide()

    scene.tables["contacts"].reserve({"contact": 32})
    scene.grow_scratch(len(shapes), 64)
    scene.collide()
    assert len(scene.contacts("impulse")) == 32
    kept = (scene.contacts("shapes")[:, :2] == 3).any(axis=1)
    assert_allclose(scene.contacts("impulse")[kept], 7.0)
    assert_allclose(scene.contacts("impulse")[~kept], 0.0)


def test_pairs_without_room_are_counted():
    scene = Scene([plane(), *(sphere(0.5, position=(2 * i, 0, 0.5)) for i in range(30))], pair_room=16)
    assert scene.tables["pairs"].capacity["pair"] == 16
    scene.collide()
    assert scene.status[[STATUS, PAIRS_WANTED]].tolist() == [OVERFLOW, 30]
    assert len(scene.contacts("impulse")) == 0
    scene.grow_scratch(31, 30)
    scene.collide()
    assert len(scene.contacts("impulse")) == 30
