"""What rests on its contacts is still, and nothing that has to move is held by that."""

import math

import numpy as np
import pytest
from tests.physics.contact_scenes import GRAVITY, HALF, WEIGHT, add_box, add_floor, earth, motion, place

from carom import Body, World
from carom.engine.parameters import DEFAULT_TIME_STEP
from carom.model.body_spec import BASE


def _stack(world: World, height: int) -> list[Body]:
    add_floor(world)
    return [add_box(world, (0.0, 0.0, HALF + 2 * HALF * i)) for i in range(height)]


def _sweeps(world: World) -> int:
    return int(world.arrays.state.numpy["tree_iterations"][0].max())


@pytest.mark.parametrize("height", [1, 3, 5])
def test_a_stack_at_rest_is_still_and_takes_hardly_a_sweep(height: int) -> None:
    world = earth()
    stack = _stack(world, height)
    world.step(480)
    taken = []
    for _ in range(120):
        world.step()
        taken.append(_sweeps(world))
    assert np.mean(taken) <= 2.0
    assert max(np.abs(motion(box)).max() for box in stack) < 2e-5


@pytest.mark.parametrize("turn", [1e-4, 0.02, 0.5])
def test_a_stack_of_turned_boxes_is_still_and_takes_hardly_a_sweep(turn: float) -> None:
    world = earth()
    stack = _stack(world, 5)
    for i, box in enumerate(stack):
        angle = turn * math.sin(5.0 * i)
        box.set_inertial_pose(place(box).tolist(), (0.0, 0.0, math.sin(angle / 2), math.cos(angle / 2)))
    world.step(480)
    start = [place(box) for box in stack]
    taken = []
    for _ in range(480):
        world.step()
        taken.append(_sweeps(world))
    assert np.mean(taken) <= 2.0
    assert max(np.abs(motion(box)).max() for box in stack) < 2e-5
    np.testing.assert_allclose([place(box) for box in stack], start, atol=1e-6)


def _pushed(box: Body, force: tuple[float, float, float], steps: int) -> None:
    for _ in range(steps):
        box.links[BASE].apply_force(force)
        box.world.step()


def test_a_force_just_above_the_weight_lifts() -> None:
    world = earth()
    (box,) = _stack(world, 1)
    world.step(240)
    assert np.abs(motion(box)).max() < 1e-6
    _pushed(box, (0.0, 0.0, 1.002 * WEIGHT), 240)
    assert place(box)[2] - HALF == pytest.approx(0.5 * 0.002 * GRAVITY, rel=0.05)


def test_a_force_just_above_friction_pushes() -> None:
    world = earth()
    (box,) = _stack(world, 1)
    world.step(240)
    friction = 0.5 * 0.5 * WEIGHT
    _pushed(box, (0.998 * friction, 0.0, 0.0), 120)
    assert abs(place(box)[0]) < 1e-5
    _pushed(box, (1.01 * friction, 0.0, 0.0), 240)
    assert place(box)[0] > 0.5 * 0.5 * 0.01 * friction


@pytest.mark.parametrize("slope", [1e-3, 1e-4])
def test_a_box_slides_down_the_slightest_slope_without_friction(slope: float) -> None:
    world = earth()
    add_floor(world, lateral_friction=0.0)
    box = add_box(world, (0.0, 0.0, HALF), lateral_friction=0.0)
    world.step(240)
    world.gravity = (GRAVITY * slope, 0.0, -GRAVITY)
    world.step(240)
    assert place(box)[0] == pytest.approx(0.5 * GRAVITY * slope, rel=0.02)


def test_a_box_slowly_goes_with_the_floor() -> None:
    world = earth()
    floor = add_floor(world)
    box = add_box(world, (0.0, 0.0, HALF))
    world.step(240)
    floor.set_base_velocity((5e-5, 0.0, 0.0), (0.0, 0.0, 0.0))
    world.step(240)
    assert place(box)[0] == pytest.approx(5e-5, rel=0.02)


@pytest.mark.parametrize("lean", [1e-3, -1e-3])
def test_a_box_on_its_edge_falls_the_way_it_leans(lean: float) -> None:
    world = earth()
    add_floor(world)
    angle = math.pi / 4 + lean
    box = add_box(world, (0.0, 0.0, HALF * math.sqrt(2.0)))
    box.set_inertial_pose(
        (0.0, 0.0, HALF * math.sqrt(2.0)), (0.0, math.sin(angle / 2), 0.0, math.cos(angle / 2))
    )
    world.step(480)
    assert place(box)[2] == pytest.approx(HALF, abs=1e-3)
    assert math.copysign(1.0, place(box)[0]) == math.copysign(1.0, lean)


def test_boxes_pressed_together_in_space_drift_on() -> None:
    world = World()
    left, right = (add_box(world, (x, 0.0, 0.0)) for x in (-HALF, HALF))
    drift = 5e-5
    for _ in range(240):
        left.links[BASE].apply_force((1.0, 0.0, 0.0))
        right.links[BASE].apply_force((-1.0, 0.0, 0.0))
        world.step()
    for box in (left, right):
        box.set_base_velocity((0.0, drift, 0.0), (0.0, 0.0, 0.0))
    start = place(left)[1] + place(right)[1]
    for _ in range(240):
        left.links[BASE].apply_force((1.0, 0.0, 0.0))
        right.links[BASE].apply_force((-1.0, 0.0, 0.0))
        world.step()
    assert place(left)[1] + place(right)[1] - start == pytest.approx(2.0 * drift * 240 * DEFAULT_TIME_STEP)


def test_what_is_put_back_moves_as_it_did_the_first_time() -> None:
    world = earth()
    stack = _stack(world, 3)
    ways = []
    for _ in range(3):
        for i, box in enumerate(stack):
            box.set_inertial_pose((0.0, 0.0, HALF + 2 * HALF * i), (0.0, 0.0, 0.0, 1.0))
            box.set_base_velocity((0.0, 0.0, 0.0), (0.0, 0.0, 0.0))
        world.step(40)
        ways.append(np.concatenate([np.append(place(box), motion(box)) for box in stack]))
    # Contacts of before that have not parted stay, so rounding remembers.
    np.testing.assert_allclose(ways[1], ways[2], atol=1e-9)
    np.testing.assert_allclose(ways[0], ways[1], atol=1e-3)
