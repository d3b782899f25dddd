"""Worlds of many contacts: the same bits every time, room for all, and faults that stay where they arise."""

import math

import numpy as np
import pytest
from tests.physics.contact_scenes import GRAVITY, HALF, add_ball, add_box, add_floor, earth, impulses, place
from tests.physics.robots import coordinates

from carom import Body, World
from carom.errors import SimulationError

COUNT = 60


def heap(world: World, count: int = COUNT) -> list[Body]:
    """Boxes and balls that fall onto each other."""
    add_floor(world)
    bodies = []
    for i in range(count):
        add = add_ball if i % 3 == 0 else add_box
        bodies.append(add(world, (0.13 * (i % 4), 0.11 * (i // 4 % 4), 0.15 + 0.21 * (i // 16))))
    return bodies


def test_two_runs_give_the_same_bits() -> None:
    first, second = earth(), earth()
    for world in (first, second):
        heap(world, 20)
        world.step(240)
    assert first.contact_arrays.contact_count > 40
    np.testing.assert_array_equal(first.position, second.position)
    np.testing.assert_array_equal(first.velocity, second.velocity)
    np.testing.assert_array_equal(impulses(first), impulses(second))


@pytest.mark.parametrize("substeps", [0, 2])
def test_contacts_beyond_the_room_there_was_change_nothing(substeps: int) -> None:
    small, roomy = earth(substeps=substeps), earth(substeps=substeps)
    few = heap(small)
    roomy.engine.workspace.pairs.reserve({"pair": 5000})
    roomy.contact_arrays.contacts.reserve({"contact": 5000})
    roomy.engine.workspace.pair_rows.reserve({"row": 20000, "jacobian": 40000})
    many = heap(roomy)
    room = small.contact_arrays.contacts.capacity["contact"]
    for world in (small, roomy):
        world.step(100)
    assert small.contact_arrays.contact_count > room
    assert small.contact_arrays.contacts.capacity["contact"] < 5000
    for ours, theirs in zip(few, many, strict=True):
        for values, expected in zip(coordinates(ours), coordinates(theirs), strict=True):
            np.testing.assert_array_equal(values, expected)


def test_a_body_elsewhere_does_not_notice_that_contacts_outgrow_the_arrays() -> None:
    # All boxes reach the floor within one step, in different substeps of it.
    substeps, steps = 8, 20
    world = earth(substeps=substeps)
    add_floor(world)
    faller = add_ball(world, (0.0, 100.0, 50.0))
    drop = 0.9 * GRAVITY / 2.0 * (5.0 / 240.0) ** 2
    for i in range(40):
        for j in range(5):
            add_box(world, (0.5 * i, 0.5 * j, HALF + 0.02 + drop * (1.0 + 0.02 * i)))
    room = world.contact_arrays.contacts.capacity["contact"]
    world.step(steps)
    assert world.contact_arrays.contact_count > room
    h, n = world.parameters.substep_time, steps * substeps
    assert place(faller)[2] == pytest.approx(50.0 - GRAVITY * h * h * n * (n + 1) / 2.0, abs=1e-9)


def test_a_heap_comes_to_rest_above_the_floor() -> None:
    world = earth()
    bodies = heap(world, 24)
    world.step(480)
    assert min(place(body)[2] for body in bodies) > 0.9 * HALF


def test_contacts_of_a_spoiled_body_spoil_no_other() -> None:
    world = earth()
    add_floor(world)
    lower, upper = add_box(world, (0.0, 0.0, HALF)), add_box(world, (0.0, 0.0, 3 * HALF))
    world.step(60)
    coordinates(upper)[1][2] = math.nan
    before, pushes = coordinates(lower)[0].copy(), impulses(world).copy()
    with pytest.raises(SimulationError):
        world.step()
    np.testing.assert_array_equal(coordinates(lower)[0], before)
    np.testing.assert_array_equal(impulses(world), pushes)
    coordinates(upper)[1][:] = 0.0
    world.step(240)
    np.testing.assert_allclose(place(upper), (0.0, 0.0, 3 * HALF), atol=1e-3)


def test_a_spoiled_body_can_be_taken_out() -> None:
    world = earth()
    add_floor(world)
    lower, upper = add_box(world, (0.0, 0.0, HALF)), add_box(world, (0.0, 0.0, 3 * HALF))
    world.step(60)
    coordinates(upper)[0][2] = math.nan
    with pytest.raises(SimulationError):
        world.step()
    world.remove(upper.id)
    world.step(120)
    np.testing.assert_allclose(place(lower), (0.0, 0.0, HALF), atol=1e-3)


def test_a_push_without_end_leaves_the_heap_where_it_was() -> None:
    world = earth()
    bodies = heap(world, 12)
    world.step(120)
    before = world.position.copy()
    world.link_force[bodies[3].first_link, :] = math.inf
    with pytest.raises(SimulationError):
        world.step()
    np.testing.assert_array_equal(world.position, before)
    world.step(60)
    assert np.isfinite(world.position).all()
