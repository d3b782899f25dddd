"""getContactPoints and performCollisionDetection; the expected values are what PyBullet 3.2.7 answers."""

from math import pi
from typing import Any

import pytest
from tests.pybullet.contacts.touching import BALL, FLOOR, PAIR, RADIUS, WEIGHT, add_pair, balls

import pybullet as p

__all__ = ["balls"]

ON_BALL = (FLOOR, BALL, -1, -1)
ON_BASE = (FLOOR, PAIR, -1, -1)
ON_LINK = (FLOOR, PAIR, -1, 0)


def swapped(place: tuple[int, int, int, int]) -> tuple[int, int, int, int]:
    return place[1], place[0], place[3], place[2]


FILTERS: list[tuple[dict[str, int], list[tuple[int, int, int, int]]]] = [
    ({}, [ON_BALL, ON_BASE, ON_LINK]),
    ({"bodyA": FLOOR}, [ON_BALL, ON_BASE, ON_LINK]),
    ({"bodyA": BALL}, [swapped(ON_BALL)]),
    ({"bodyB": BALL}, [ON_BALL]),
    ({"bodyA": FLOOR, "bodyB": BALL}, [ON_BALL]),
    ({"bodyA": BALL, "bodyB": FLOOR}, [swapped(ON_BALL)]),
    ({"bodyA": PAIR}, [swapped(ON_BASE), swapped(ON_LINK)]),
    ({"bodyA": PAIR, "linkIndexA": 0}, [swapped(ON_LINK)]),
    ({"bodyA": PAIR, "linkIndexA": -1}, [swapped(ON_BASE)]),
    ({"bodyA": -7}, [ON_BALL, ON_BASE, ON_LINK]),
    ({"bodyA": -7, "bodyB": -7}, [ON_BALL, ON_BASE, ON_LINK]),
    ({"bodyB": FLOOR}, []),
    ({"linkIndexA": 0}, []),
    ({"linkIndexA": -1}, [ON_BALL, ON_BASE, ON_LINK]),
    ({"bodyA": FLOOR, "linkIndexA": -5, "linkIndexB": -5}, [ON_BALL, ON_BASE, ON_LINK]),
    ({"linkIndexB": 0}, [ON_LINK]),
    ({"bodyA": FLOOR, "linkIndexB": 0}, [ON_LINK]),
    ({"bodyA": FLOOR, "bodyB": PAIR, "linkIndexA": -1, "linkIndexB": 0}, [ON_LINK]),
    ({"bodyA": BALL, "bodyB": PAIR}, []),
    ({"bodyA": BALL, "linkIndexA": 5}, []),
    ({"bodyA": 99}, []),
]


def settle() -> None:
    for _ in range(30):
        p.stepSimulation()


@pytest.mark.usefixtures("balls")
@pytest.mark.parametrize(("asked", "places"), FILTERS)
def test_contacts_are_those_asked_for(asked: dict[str, int], places: list[tuple[int, int, int, int]]) -> None:
    settle()
    points = p.getContactPoints(**asked)
    assert sorted(point[1:5] for point in points) == sorted(places)
    for point in points:
        # The normal points to the body listed first.
        up = -1.0 if point[1] == FLOOR else 1.0
        assert point[7] == pytest.approx((0.0, 0.0, up), abs=1e-9)
        assert point[9] == pytest.approx(WEIGHT, rel=1e-4)


@pytest.mark.usefixtures("balls")
def test_a_contact_has_pybullets_fields() -> None:
    settle()
    (point,) = p.getContactPoints(BALL)
    assert len(point) == 14
    assert point[:5] == (0, BALL, FLOOR, -1, -1)
    assert point[5] == pytest.approx((0.0, 0.0, -1e-5), abs=1e-12)
    assert point[6] == pytest.approx((0.0, 0.0, 0.0), abs=1e-12)
    assert point[8] == pytest.approx(-1e-5, rel=1e-6)
    assert (point[10], point[12]) == pytest.approx((0.0, 0.0), abs=1e-9)
    assert point[11] == pytest.approx((0.0, 1.0, 0.0), abs=1e-9)
    assert point[13] == pytest.approx((1.0, 0.0, 0.0), abs=1e-9)


@pytest.mark.usefixtures("balls")
def test_swapping_bodies_swaps_points_and_turns_the_normal() -> None:
    settle()
    (one,), (other,) = p.getContactPoints(FLOOR, BALL), p.getContactPoints(BALL, FLOOR)
    assert one[5] == other[6]
    assert one[6] == other[5]
    assert one[7] == pytest.approx([-x for x in other[7]])
    assert one[8:11] == other[8:11]


@pytest.mark.usefixtures("balls")
def test_contacts_are_found_without_a_step_and_have_no_force_then() -> None:
    assert p.getContactPoints() == ()
    p.performCollisionDetection()
    points = p.getContactPoints()
    assert sorted(point[1:5] for point in points) == sorted([ON_BALL, ON_BASE, ON_LINK])
    assert [point[9] for point in points] == [0.0, 0.0, 0.0]
    assert points[0][11] == pytest.approx((0.0, 1.0, 0.0), abs=1e-9)
    assert points[0][13] == pytest.approx((1.0, 0.0, 0.0), abs=1e-9)
    assert p.getBasePositionAndOrientation(BALL)[0] == (0.0, 0.0, RADIUS)


@pytest.mark.usefixtures("balls")
def test_contacts_found_again_without_a_step_keep_their_forces() -> None:
    settle()
    before = p.getContactPoints()
    p.performCollisionDetection()
    assert [point[9] for point in p.getContactPoints()] == [point[9] for point in before]
    p.resetBasePositionAndOrientation(BALL, [0, 0, 0.3], [0, 0, 0, 1])
    p.performCollisionDetection()
    p.resetBasePositionAndOrientation(BALL, [0, 0, RADIUS], [0, 0, 0, 1])
    p.performCollisionDetection()
    assert [point[9] for point in p.getContactPoints(BALL)] == [0.0]
    assert [point[9] for point in p.getContactPoints(PAIR)] == pytest.approx([WEIGHT] * 2, rel=1e-4)


@pytest.mark.usefixtures("balls")
def test_contacts_stay_until_they_are_found_anew() -> None:
    settle()
    p.resetBasePositionAndOrientation(BALL, [0, 0, 0.3], [0, 0, 0, 1])
    assert len(p.getContactPoints(BALL)) == 1
    p.performCollisionDetection()
    assert p.getContactPoints(BALL) == ()
    assert len(p.getContactPoints(PAIR)) == 2


@pytest.mark.usefixtures("balls")
def test_contacts_of_a_removed_body_are_gone() -> None:
    settle()
    p.removeBody(BALL)
    assert p.getContactPoints(BALL) == ()
    p.stepSimulation()
    assert sorted(point[1:5] for point in p.getContactPoints()) == sorted([ON_BASE, ON_LINK])


@pytest.mark.usefixtures("balls")
def test_resetting_the_simulation_forgets_contacts() -> None:
    settle()
    p.resetSimulation()
    assert p.getContactPoints() == ()
    p.performCollisionDetection()
    assert p.getContactPoints() == ()


@pytest.mark.usefixtures("balls")
@pytest.mark.parametrize("argument", ["bodyA", "bodyB", "linkIndexA", "linkIndexB"])
def test_what_is_no_integer_is_refused(argument: str) -> None:
    for wrong in ("x", None, 1.5, [0], object()):
        given: dict[str, Any] = {argument: wrong}
        with pytest.raises(TypeError, match=argument):
            p.getContactPoints(**given)
    with pytest.raises(OverflowError):
        p.getContactPoints(**{argument: 2**40})


@pytest.mark.parametrize("function", [p.getContactPoints, p.performCollisionDetection])
def test_without_a_connection(function: Any) -> None:
    with pytest.raises(p.error, match="Not connected"):
        function()


@pytest.mark.parametrize("half", [0.05, 0.07, 0.1, 0.12, 0.15, 0.2, 0.25, 0.3, 0.35])
def test_a_box_placed_exactly_on_another_touches_it(client: int, half: float) -> None:
    p.setGravity(0, 0, -9.81)
    p.createMultiBody(0, p.createCollisionShape(p.GEOM_BOX, halfExtents=[1, 1, 0.5]))
    shape = p.createCollisionShape(p.GEOM_BOX, halfExtents=[half] * 3)
    box = p.createMultiBody(1, shape, basePosition=[0, 0, 0.5 + half])
    p.performCollisionDetection()
    assert len(p.getContactPoints()) == 4
    p.stepSimulation()
    height = p.getBasePositionAndOrientation(box)[0][2]
    assert height == pytest.approx(0.5 + half - 9.975073303e-06, abs=1e-12), "as in PyBullet"


def test_a_spring_on_one_side_works_beside_the_damper_of_the_other(client: int) -> None:
    p.setGravity(0, 0, -9.81)
    floor = p.createMultiBody(0, p.createCollisionShape(p.GEOM_BOX, halfExtents=[1, 1, 0.5]))
    ball = p.createMultiBody(1, p.createCollisionShape(p.GEOM_SPHERE, radius=0.1), basePosition=[0, 0, 0.65])
    p.changeDynamics(floor, -1, contactStiffness=800, contactDamping=1.0)
    heights = []
    for _ in range(201):
        p.stepSimulation()
        heights.append(p.getBasePositionAndOrientation(ball)[0][2])
    expected = [0.6498296875, 0.5571409966095049, 0.6152327377354755, 0.5898758815424251, 0.5747081545292421]
    assert heights[:200:40] == pytest.approx(expected, abs=1e-9)


_SHAPES: dict[str, dict[str, Any]] = {
    "ball": {"shapeType": p.GEOM_SPHERE, "radius": 0.1},
    "box": {"shapeType": p.GEOM_BOX, "halfExtents": [0.1] * 3},
    "shifted box": {
        "shapeType": p.GEOM_BOX,
        "halfExtents": [0.1] * 3,
        "collisionFramePosition": [0.001, 0, 0],
    },
    "plane": {"shapeType": p.GEOM_PLANE},
    "heightfield": {
        "shapeType": p.GEOM_HEIGHTFIELD,
        "heightfieldData": [0.0] * 100,
        "numHeightfieldRows": 10,
        "numHeightfieldColumns": 10,
    },
}
_SURFACES = ("plane", "heightfield")


@pytest.mark.parametrize(
    ("lower", "upper", "first"),
    [
        ("ball", "box", 0),
        ("box", "ball", 0),
        ("ball", "shifted box", 1),
        ("shifted box", "ball", 0),
        ("plane", "ball", 1),
        ("plane", "shifted box", 1),
        ("heightfield", "box", 1),
    ],
)
def test_the_shapes_decide_which_body_comes_first(client: int, lower: str, upper: str, first: int) -> None:
    gap = 0.1 if lower in _SURFACES else 0.2
    for name, mass, height in ((lower, 0, 0.0), (upper, 1, gap - 0.0005)):
        p.createMultiBody(mass, p.createCollisionShape(**_SHAPES[name]), basePosition=[0, 0, height])
    p.performCollisionDetection()
    points = p.getContactPoints()
    assert {point[1] for point in points} == {first}
    up = 1.0 if first == 1 else -1.0
    assert points[0][7] == pytest.approx((0.0, 0.0, up), abs=1e-9)
    assert points[0][11] == pytest.approx((0.0, -up, 0.0), abs=1e-9)


def test_links_fixed_to_a_fixed_base_touch_other_fixed_bodies_without_force(client: int) -> None:
    """As in PyBullet: only the bases of two fixed bodies do not touch."""
    p.setGravity(0, 0, -10)
    ball = p.createCollisionShape(p.GEOM_SPHERE, radius=RADIUS)
    floor, lamp = p.createMultiBody(0, p.createCollisionShape(p.GEOM_PLANE)), add_pair(0, ball)
    loose = p.createMultiBody(1, ball, basePosition=[1.699, 0, RADIUS])
    for _ in range(10):
        p.stepSimulation()
    (contact,) = p.getContactPoints(lamp, floor)
    assert contact[3] == 0
    assert contact[9] == 0
    (contact,) = p.getContactPoints(loose, floor)
    assert contact[9] == pytest.approx(10, rel=1e-4)
    assert [contact[4] for contact in p.getContactPoints(loose, lamp)] == [0]
    p.setCollisionFilterGroupMask(lamp, -1, 1, -1)
    p.performCollisionDetection()
    assert sorted(contact[3] for contact in p.getContactPoints(lamp, floor)) == [-1, 0]


def test_links_below_minus_one_stand_for_all(client: int) -> None:
    ball = p.createCollisionShape(p.GEOM_SPHERE, radius=0.1)
    first, second = (p.createMultiBody(1, ball, basePosition=[x, 0, 0]) for x in (0.0, 0.15))
    p.performCollisionDetection()
    for link in (-2, -3, -7):
        assert len(p.getContactPoints(linkIndexA=link, linkIndexB=link)) == 1
        assert len(p.getClosestPoints(first, second, 1.0, link, link)) == 1


@pytest.mark.parametrize(
    ("half", "turn", "normal"),
    [
        ((0.1, 0.1, 0.1), (0, 0, 0, 1), (-1, 0, 0)),
        ((0.1, 0.1, 0.2), (0, 0, 0, 1), (-1, 0, 0)),
        ((0.2, 0.1, 0.1), (0, 0, 0, 1), (0, -1, 0)),
        ((0.1, 0.2, 0.1), (0, 0, 0, 1), (-1, 0, 0)),
        ((0.1, 0.1, 0.1), (0.5, 0.5, 0.5, 0.5), (-1, 0, 0)),
    ],
)
def test_boxes_with_one_centre_part_along_the_first_of_their_shortest_axes(
    client: int, half: tuple[float, ...], turn: tuple[float, ...], normal: tuple[float, ...]
) -> None:
    for orientation in ((0, 0, 0, 1), turn):
        shape = p.createCollisionShape(p.GEOM_BOX, halfExtents=half, physicsClientId=client)
        p.createMultiBody(1.0, shape, baseOrientation=orientation, physicsClientId=client)
    p.performCollisionDetection(physicsClientId=client)
    points = p.getContactPoints(physicsClientId=client)
    assert points
    for point in points:
        assert point[7] == pytest.approx(normal, abs=1e-9)


@pytest.mark.parametrize(
    ("floor", "turn", "places"),
    [
        ((1, 1, 0.5), (0, 0, 0.3), [(-0.036, -0.221), (-0.155, 0.162), (0.036, 0.221), (0.155, -0.162)]),
        ((1, 1, 0.5), (pi, 0, 0.3), [(-0.155, 0.162), (-0.036, -0.221), (0.155, -0.162), (0.036, 0.221)]),
        ((0.08, 1, 0.5), (0, 0, 0), [(-0.08, 0.2), (0.08, 0.2), (0.08, -0.2), (-0.08, -0.2)]),
        ((1, 0.05, 0.5), (0, pi / 2, 0), [(0.05, -0.05), (0.05, 0.05), (-0.05, 0.05), (-0.05, -0.05)]),
    ],
)
def test_the_corners_of_a_box_on_a_box_come_in_pybullets_order(
    client: int, floor: tuple[float, ...], turn: tuple[float, ...], places: list[tuple[float, float]]
) -> None:
    ground = p.createCollisionShape(p.GEOM_BOX, halfExtents=floor)
    p.createMultiBody(0, ground, basePosition=[0, 0, -0.5])
    half = (0.1, 0.2, 0.05)
    height = half[0] if turn[1] else half[2]
    p.createMultiBody(
        1,
        p.createCollisionShape(p.GEOM_BOX, halfExtents=half),
        basePosition=[0, 0, height - 1e-3],
        baseOrientation=p.getQuaternionFromEuler(turn),
    )
    p.performCollisionDetection()
    assert [point[5][:2] for point in p.getContactPoints()] == [pytest.approx(xy, abs=1e-3) for xy in places]
