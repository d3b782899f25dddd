"""Which hulls roll, and about which of their axes."""

import numpy as np
import pytest

from carom.geometry.hull import convex_hull
from carom.geometry.rolling import flat_faces_first, round_about


def prism(sides: int, radius: float = 0.1, length: float = 0.05) -> np.ndarray:
    """Corners of a prism along z, turned by a little."""
    angles = 0.1 + 2.0 * np.pi * np.arange(sides) / sides
    return np.array(
        [(radius * np.cos(a), radius * np.sin(a), z) for a in angles for z in (-length / 2, length / 2)]
    )


def ball(points: int) -> np.ndarray:
    """Points spread evenly over a ball."""
    z = 1.0 - 2.0 * (np.arange(points) + 0.5) / points
    angle = np.pi * (3.0 - np.sqrt(5.0)) * np.arange(points)
    flat = np.sqrt(1.0 - z * z)
    return np.stack([flat * np.cos(angle), flat * np.sin(angle), z], axis=1)


@pytest.mark.parametrize("sides", [8, 16, 33, 64])
@pytest.mark.parametrize("length", [0.02, 0.15, 0.2, 1.0])
@pytest.mark.parametrize("axis", [0, 1, 2])
def test_prisms_of_many_sides_roll_about_their_axis(sides: int, length: float, axis: int) -> None:
    points = np.roll(prism(sides, length=length), axis - 2, axis=1)
    expected = tuple(i == axis for i in range(3))
    assert round_about(convex_hull(points)) == expected
    assert round_about(convex_hull(points + np.array((3.0, -2.0, 0.5)))) == expected


def test_a_tyre_with_rounded_shoulders_rolls() -> None:
    tyre = np.concatenate([prism(24, 0.1, 0.04), prism(24, 0.09, 0.06)])
    assert round_about(convex_hull(tyre)) == (False, False, True)


def test_balls_roll_about_any_axis() -> None:
    assert round_about(convex_hull(ball(120))) == (True, True, True)


@pytest.mark.parametrize(
    "points",
    [
        prism(3),
        prism(4),
        prism(6),
        prism(32) * (1.0, 0.8, 1.0),
        prism(32)[:40],
        np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], dtype=float),
        np.zeros((4, 3)),
    ],
    ids=["triangle", "square", "hexagon", "ellipse", "part of a wheel", "cube", "point"],
)
def test_other_things_do_not_roll(points: np.ndarray) -> None:
    assert round_about(convex_hull(points)) == (False, False, False)


def test_faces_to_lie_on_come_first() -> None:
    # The lower half of a ball, cut off flat.
    points = 0.1 * ball(300)
    solid = convex_hull(np.column_stack([points[:, :2], np.minimum(points[:, 2], 0.0)]))
    arranged, count = flat_faces_first(solid)
    assert count == 1
    assert arranged.planes[0, :3] == pytest.approx((0, 0, 1))
    corners = arranged.corners[: arranged.corner_count[0]]
    assert arranged.vertices[corners, 2] == pytest.approx(0.0)
    assert sorted(arranged.planes.tolist()) == sorted(solid.planes.tolist())
    for plane, first, number in zip(
        arranged.planes, arranged.first_corner, arranged.corner_count, strict=True
    ):
        around = arranged.vertices[arranged.corners[first : first + number]]
        assert around @ plane[:3] == pytest.approx(plane[3], abs=1e-6)


def test_cubes_lie_on_all_their_faces_and_balls_on_none() -> None:
    cube = [(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]
    assert flat_faces_first(convex_hull(np.array(cube, dtype=float)))[1] == 6
    assert flat_faces_first(convex_hull(ball(100)))[1] == 0
