"""Laws that bodies obey when they touch."""

import math

import numpy as np
import pytest
from tests.physics.contact_scenes import (
    GRAVITY,
    HALF,
    WEIGHT,
    add_ball,
    add_box,
    add_floor,
    earth,
    impulses,
    motion,
    place,
)
from tests.physics.robots import coordinates

from carom import Body, World
from carom.engine.parameters import DEFAULT_TIME_STEP


def exact() -> World:
    """A world without gravity whose contacts may not overlap at all."""
    world = World(contact="bullet")
    world.parameters.contact_slop = 0.0
    return world


def linear(body: Body) -> np.ndarray:
    """Velocity of the base's centre, shape (3,)."""
    return motion(body)[3:]


def tilted(slope: float) -> World:
    """A world whose floor slopes down along x."""
    world = earth()
    world.gravity = (GRAVITY * math.sin(slope), 0.0, -GRAVITY * math.cos(slope))
    return world


@pytest.mark.parametrize("substeps", [0, 4])
def test_a_dropped_box_comes_to_rest_on_the_floor(substeps: int) -> None:
    world = earth(substeps=substeps)
    add_floor(world)
    box = add_box(world, (0.3, -0.2, 0.5))
    world.step(480)
    np.testing.assert_allclose(place(box), (0.3, -0.2, HALF), atol=2e-4)
    np.testing.assert_allclose(motion(box), 0.0, atol=1e-4)


def test_the_contacts_of_a_box_at_rest_bear_its_weight() -> None:
    world = earth()
    add_floor(world)
    add_box(world, (0.0, 0.0, HALF + 0.01))
    world.step(480)
    assert world.contact_arrays.contact_count == 4
    total = impulses(world).sum(axis=0) / DEFAULT_TIME_STEP
    assert total[0] == pytest.approx(WEIGHT, rel=1e-3)


def test_a_stack_of_ten_boxes_stands() -> None:
    world = earth()
    add_floor(world)
    stack = [add_box(world, (0.0, 0.0, HALF + 2 * HALF * i)) for i in range(10)]
    world.step(960)
    for i, box in enumerate(stack):
        np.testing.assert_allclose(place(box), (0.0, 0.0, HALF + 2 * HALF * i), atol=1e-2)
        assert np.abs(motion(box)).max() < 0.01


@pytest.mark.parametrize("height", [2, 5])
def test_a_stack_that_starts_from_its_last_impulses_comes_to_rest(height: int) -> None:
    world = earth()
    add_floor(world)
    stack = [add_box(world, (0.0, 0.0, HALF + 2 * HALF * i)) for i in range(height)]
    world.step(240)
    for _ in range(12):
        world.step(60)
        assert max(np.abs(motion(box)).max() for box in stack) < 2e-4
    slop = world.parameters.contact_slop
    assert place(stack[-1])[2] == pytest.approx((2 * height - 1) * HALF - height * slop, abs=1e-6)
    total = impulses(world)[:4].sum(axis=0) / DEFAULT_TIME_STEP
    assert total[0] == pytest.approx(height * WEIGHT, rel=1e-4)


def test_a_stack_at_rest_takes_few_sweeps() -> None:
    sweeps = []
    for share in (0.0, 1.0):
        world = earth(contact_warm_starting=share)
        add_floor(world)
        for i in range(3):
            add_box(world, (0.0, 0.0, HALF + 2 * HALF * i))
        world.step(240)
        taken = []
        for _ in range(20):
            world.step()
            taken.append(int(world.arrays.state.numpy["tree_iterations"][0].max()))
        sweeps.append(taken)
    assert min(sweeps[0]) == 50
    assert max(sweeps[1]) <= 20


def test_a_push_wakes_up_a_calm_stack() -> None:
    places = []
    for share in (0.0, 1.0):
        world = earth(contact_warm_starting=share)
        add_floor(world)
        stack = [add_box(world, (0.0, 0.0, HALF + 2 * HALF * i)) for i in range(3)]
        world.step(240)
        stack[1].set_base_velocity((1.5, 0.0, 0.0), (0.0, 0.0, 0.0))
        # Later the upper box lands on an edge, and rounding decides which corner touches first.
        world.step(60)
        places.append([place(box) for box in stack])
    assert places[0][1][0] > 0.02
    np.testing.assert_allclose(places[1], places[0], atol=2e-3)


@pytest.mark.parametrize("offset", [0.0, 0.07])
def test_balls_that_collide_keep_momentum_and_energy(offset: float) -> None:
    speed, steps = 2.0, 40
    world = exact()
    surface = {"restitution": 1.0, "lateral_friction": 0.0}
    touching = math.sqrt(4.0 * HALF**2 - offset**2)
    striker = add_ball(world, (-touching - steps * speed * DEFAULT_TIME_STEP, offset, 0.0), **surface)
    target = add_ball(world, (0.0, 0.0, 0.0), **surface)
    striker.set_base_velocity((speed, 0.0, 0.0), (0.0, 0.0, 0.0))
    world.step(2 * steps)
    after = linear(striker), linear(target)
    np.testing.assert_allclose(after[0] + after[1], (speed, 0.0, 0.0), atol=1e-12)
    assert sum(float(v @ v) for v in after) == pytest.approx(speed**2, rel=1e-9)
    # The target leaves along the line of centres.
    assert after[1][1] / after[1][0] == pytest.approx(-offset / touching, abs=1e-9)


def test_friction_between_balls_keeps_momentum() -> None:
    world = World(contact="bullet")
    striker, target = add_ball(world, (-0.5, 0.1, 0.0)), add_ball(world, (0.0, 0.0, 0.0))
    striker.set_base_velocity((2.0, 0.0, 0.0), (0.0, 0.0, 5.0))
    world.step(120)
    np.testing.assert_allclose(linear(striker) + linear(target), (2.0, 0.0, 0.0), atol=1e-12)
    assert np.abs(motion(target)[:3]).max() > 0.1


@pytest.mark.parametrize("restitution", [0.25, 0.5, 0.8, 1.0])
def test_a_ball_bounces_with_its_share_of_the_speed(restitution: float) -> None:
    assert speed_after_impact(2.0, restitution) == pytest.approx(2.0 * restitution, rel=1e-9)


@pytest.mark.parametrize("speed", [0.05, 0.19])
def test_slow_impacts_do_not_bounce(speed: float) -> None:
    assert speed_after_impact(speed, 1.0) == pytest.approx(0.0, abs=1e-9)


def speed_after_impact(speed: float, restitution: float) -> float:
    """How fast a ball leaves a perfect floor that it hits at the end of a step."""
    world = exact()
    add_floor(world, restitution=1.0)
    ball = add_ball(world, (0.0, 0.0, HALF + 20 * speed * DEFAULT_TIME_STEP), restitution=restitution)
    ball.set_base_velocity((0.0, 0.0, -speed), (0.0, 0.0, 0.0))
    world.step(40)
    return float(linear(ball)[2])


@pytest.mark.parametrize("friction", [0.2, 0.5, 0.8])
def test_a_box_slides_on_slopes_steeper_than_its_friction(friction: float) -> None:
    for factor in (0.95, 1.05):
        slope = math.atan(factor * friction)
        world = tilted(slope)
        add_floor(world, lateral_friction=1.0)
        box = add_box(world, (0.0, 0.0, HALF - 1e-5), lateral_friction=friction)
        world.step(240)
        speed = GRAVITY * (math.sin(slope) - friction * math.cos(slope))
        if factor < 1.0:
            assert abs(linear(box)[0]) < 1e-3
        else:
            assert linear(box)[0] == pytest.approx(speed, rel=0.1)


def test_friction_stays_in_its_cone() -> None:
    friction = 0.3
    world = earth()
    add_floor(world, lateral_friction=1.0)
    for i in range(4):
        ball = add_ball(world, (0.5 * i, 0.0, HALF), lateral_friction=friction)
        ball.set_base_velocity((3.0 * math.cos(i), 3.0 * math.sin(i), 0.0), (0.0, 4.0, 2.0))
    sliding = 0
    for _ in range(120):
        world.step()
        for normal, first, second in impulses(world):
            tangential = math.hypot(first, second)
            assert normal >= 0.0
            assert tangential <= friction * normal * (1 + 1e-9)
            sliding += tangential > 0.999 * friction * normal > 0.0
    assert sliding > 100


def test_a_rolling_ball_does_not_slip() -> None:
    world = earth()
    add_floor(world, lateral_friction=1.0)
    ball = add_ball(world, (0.0, 0.0, HALF))
    ball.set_base_velocity((1.0, 0.0, 0.0), (0.0, 0.0, 0.0))
    world.step(240)
    # A sliding ball loses two sevenths of its speed until it rolls.
    assert linear(ball)[0] == pytest.approx(5.0 / 7.0, rel=1e-6)
    assert motion(ball)[1] == pytest.approx(linear(ball)[0] / HALF, rel=1e-6)


def test_rolling_friction_stops_a_ball() -> None:
    world = earth()
    add_floor(world, rolling_friction=1.0)
    ball = add_ball(world, (0.0, 0.0, HALF), rolling_friction=0.05)
    ball.set_base_velocity((1.0, 0.0, 0.0), (0.0, 1.0 / HALF, 0.0))
    world.step(960)
    assert np.abs(motion(ball)).max() < 1e-6


def test_contacts_vanish_when_bodies_part() -> None:
    world = earth()
    add_floor(world)
    box = add_box(world, (0.0, 0.0, HALF))
    world.step(20)
    assert world.contact_arrays.contact_count == 4
    box.set_inertial_pose((0.0, 0.0, 1.0), (0.0, 0.0, 0.0, 1.0))
    world.step()
    assert world.contact_arrays.contact_count == 0


def test_a_removed_body_no_longer_bears_others() -> None:
    world = earth()
    add_floor(world)
    lower, upper = add_box(world, (0.0, 0.0, HALF)), add_box(world, (0.0, 0.0, 3 * HALF))
    world.step(60)
    world.remove(lower.id)
    assert world.contact_arrays.contact_count == 0
    world.step(480)
    np.testing.assert_allclose(place(upper), (0.0, 0.0, HALF), atol=1e-3)
    assert world.contact_arrays.contact_count == 4


def test_two_bodies_that_do_not_touch_a_third_move_as_if_alone() -> None:
    together, alone = earth(), earth()
    for world in (together, alone):
        add_floor(world)
    near, lonely = add_ball(together, (0.0, 0.0, 0.3)), add_ball(alone, (0.0, 0.0, 0.3))
    add_box(together, (5.0, 0.0, 0.2))
    for world in (together, alone):
        world.step(240)
    for values, expected in zip(coordinates(near), coordinates(lonely), strict=True):
        np.testing.assert_array_equal(values, expected)
