"""The bounds of a body are those of the points on its shapes, however it is turned."""

from __future__ import annotations

import numpy as np
import pytest

from carom import Body, Pose, World

TURN = (0.2, -0.4, 0.4, 0.8)
AT = (0.4, -1.2, 2.0)


def around(count: int = 400) -> np.ndarray:
    """Directions of the unit circle, (count, 2)."""
    angle = np.linspace(0.0, 2.0 * np.pi, count, endpoint=False)
    return np.stack([np.cos(angle), np.sin(angle)], axis=1)


def ball(radius: float) -> np.ndarray:
    """Points of a sphere, among them those along the axes of the world when the body is turned."""
    z = np.linspace(-1.0, 1.0, 401)
    rings = [np.column_stack([np.sqrt(1.0 - h * h) * around(), np.full(400, h)]) for h in z]
    return radius * np.concatenate(rings)


def points(kind: str) -> np.ndarray:
    """Points on a shape in its own frame: all its corners, or a dense covering of its edges."""
    if kind == "box":
        return np.array([(x, y, z) for x in (-0.1, 0.1) for y in (-0.3, 0.3) for z in (-0.2, 0.2)])
    if kind == "sphere":
        return ball(0.25)
    end = np.array([0.0, 0.0, 0.4])
    if kind == "capsule":
        return np.concatenate([ball(0.1) + end, ball(0.1) - end])
    rim = np.column_stack([0.1 * around(4000), np.zeros(4000)])
    return np.concatenate([rim + end, rim - end])


def body(world: World, kind: str) -> Body:
    if kind == "box":
        return world.add_box((0.1, 0.3, 0.2), AT, TURN, mass=1.0)
    if kind == "sphere":
        return world.add_sphere(0.25, AT, mass=1.0)
    add = world.add_capsule if kind == "capsule" else world.add_cylinder
    return add(0.1, 0.8, AT, TURN, mass=1.0)


@pytest.mark.parametrize("kind", ["box", "sphere", "capsule", "cylinder"])
def test_bounds_are_those_of_the_points_of_a_turned_shape(kind: str) -> None:
    world = World()
    one = body(world, kind)
    pose = Pose(AT, TURN if kind != "sphere" else (0.0, 0.0, 0.0, 1.0))
    turn = np.array(pose.rotation)
    placed = points(kind) @ turn.T + AT
    # Points are at most some thousandths of a radius from those farthest out.
    np.testing.assert_allclose(one.bounds.lower, placed.min(axis=0), atol=1e-3)
    np.testing.assert_allclose(one.bounds.upper, placed.max(axis=0), atol=1e-3)
    np.testing.assert_allclose(one.bounds.centre, AT, atol=1e-12)


def test_bounds_hold_all_links_and_follow_the_joints() -> None:
    world = World()
    world.load("""<mujoco><worldbody><body name="arm">
        <geom type="sphere" size=".1"/>
        <body pos="0 0 1"><joint name="j" axis="1 0 0"/><geom type="sphere" size=".2" pos="0 0 1"/></body>
    </body></worldbody></mujoco>""")
    arm = world["arm"]
    np.testing.assert_allclose(arm.bounds.lower, (-0.2, -0.2, -0.1), atol=1e-12)
    np.testing.assert_allclose(arm.bounds.upper, (0.2, 0.2, 2.2), atol=1e-12)
    arm.joints.positions = (np.pi / 2,)
    np.testing.assert_allclose(arm.bounds.lower, (-0.2, -1.2, -0.1), atol=1e-12)
    np.testing.assert_allclose(arm.bounds.upper, (0.2, 0.1, 1.2), atol=1e-12)


@pytest.mark.parametrize("number", [0, 1, 2])
def test_a_ray_through_two_shapes_of_a_link_meets_them_one_after_the_other(number: int) -> None:
    world = World()
    world.load("""<mujoco><worldbody><geom type="box" size=".1 .1 .1" pos="0 0 1"/>
        <geom type="box" size=".1 .1 .1" pos="0 0 2"/></worldbody></mujoco>""")
    above, below = (0.0, 0.0, 4.0), (0.0, 0.0, 0.0)
    hit = world.queries().cast_ray(above, below, hit_number=number)
    assert hit.position[2:] == pytest.approx((2.1, 1.1)[number : number + 1] or (0.0,))
    assert (hit.body >= 0) == (number < 2)
    many = world.queries().cast_rays([above], [below], hit_number=number)
    assert many == (hit,)
