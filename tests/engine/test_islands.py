"""Which bodies are solved together: those whose bounds overlap, in batches, but each pile at rest alone."""

from __future__ import annotations

import numpy as np
import pytest
from tests.physics.contact_scenes import HALF, add_ball, add_box, add_floor, earth

from carom import Body, World, Worlds
from carom.description import Pose
from carom.layouts.codes import UserConstraintKind
from carom.layouts.flags import ActivationChange
from carom.model.solver_order import batch_islands

BALLS = 24


def together(world: World, bodies: list[Body]) -> list[list[int]]:
    """The bodies of each island, by index."""
    islands = world.arrays.state.numpy["tree_island"][0]
    groups: dict[int, list[int]] = {}
    for index, body in enumerate(bodies):
        groups.setdefault(int(islands[body.rows.tree]), []).append(index)
    return list(groups.values())


def boxes_in_a_row(gap: float, **parameters: float) -> tuple[World, list[Body]]:
    world = earth(**parameters)
    add_floor(world)
    boxes = [add_box(world, (i * (2.0 * HALF + gap), 0.0, HALF)) for i in range(3)]
    return world, boxes


@pytest.mark.parametrize(("gap", "islands"), [(0.039, [[0, 1, 2]]), (0.041, [[0], [1], [2]])])
def test_bodies_are_solved_together_if_their_bounds_overlap(gap: float, islands: list[list[int]]) -> None:
    world, boxes = boxes_in_a_row(gap, contact_warm_starting=0.0)
    world.step()
    assert together(world, boxes) == islands
    reports = world.analytics()
    assert [report["numBodies"] for report in reports] == [len(island) for island in islands]


def test_a_box_at_rest_is_solved_without_those_beside_it() -> None:
    world, boxes = boxes_in_a_row(0.01)
    world.step(240)
    assert together(world, boxes) == [[0], [1], [2]]
    for box in boxes[::2]:
        box.set_base_velocity((0.0, 0.5, 0.0), (0.0, 0.0, 0.0))
    world.step()
    # What moves on both sides is one island in Bullet, because of the one at rest.
    assert together(world, boxes) == [[0, 2], [1]]
    world.step(240)
    assert together(world, boxes) == [[0], [1], [2]]


@pytest.mark.parametrize("minimum", [0, 1, 3, 7, 100])
def test_islands_are_solved_in_batches_of_more_rows_than_the_minimum(minimum: int) -> None:
    """Balls on a floor have a manifold each, some are tied together; batches as constraints have them."""
    world = earth(minimum_island_size=minimum, contact_warm_starting=0.0)
    add_floor(world)
    balls = [add_ball(world, (3.0 * HALF * i, 0.0, HALF - 1e-4)) for i in range(BALLS)]
    numbers = np.arange(BALLS)
    rows = list(range(BALLS))
    for a, b in np.random.default_rng(minimum).choice(BALLS, size=(8, 2), replace=False):
        apart = Pose((3.0 * HALF * float(a - b), 0.0, 0.0))
        world.constrain_links(
            UserConstraintKind.POINT_TO_POINT, balls[a], -1, balls[b], -1, child_frame=apart
        )
        numbers[numbers == numbers[a]] = numbers[b]
        rows.append(int(a))
    tags = sorted(int(numbers[row]) for row in rows)
    batches = [set(tags[first : first + length]) for first, length in batch_islands(tags, minimum)]
    world.step()
    wanted = [[i for i in range(BALLS) if numbers[i] in batch] for batch in batches]
    assert sorted(together(world, balls)) == sorted(wanted)


def test_bodies_asleep_are_in_no_batch() -> None:
    world, boxes = boxes_in_a_row(0.1, minimum_island_size=1, contact_warm_starting=0.0)
    boxes[1].change_dynamics(-1, activation_state=ActivationChange.ENABLE_SLEEPING | ActivationChange.SLEEP)
    world.step(2)
    assert boxes[1].asleep
    assert together(world, boxes) == [[0, 2], [1]]
    boxes[1].change_dynamics(-1, activation_state=ActivationChange.WAKE_UP)
    world.step(2)
    assert together(world, boxes) == [[0, 1], [2]]


def test_links_are_numbered_in_their_order_in_bullet() -> None:
    """The last takes the place of one that is removed; what cannot move has no number."""
    world, boxes = boxes_in_a_row(0.1)
    world.remove(boxes[0].id)
    world.step()
    rows = [boxes[1].first_link, boxes[2].first_link]
    numbers = world.arrays.model.numpy["link_number"][: world.arrays.used["link"]]
    assert numbers[rows].tolist() == [1, 0]
    assert sorted(numbers.tolist()) == [-1, 0, 1]


def test_a_constraint_that_holds_in_some_worlds_joins_bodies_there() -> None:
    scene, boxes = boxes_in_a_row(0.1, contact_warm_starting=0.0)
    apart = Pose((-2.0 * HALF - 0.1, 0.0, 0.0))
    scene.constrain_links(UserConstraintKind.POINT_TO_POINT, boxes[0], -1, boxes[1], -1, child_frame=apart)
    worlds = Worlds(scene, 2)
    islands = worlds._engine.arrays.state.numpy["tree_island"]
    rows = [box.rows.tree for box in boxes]
    for holds in ([True, True], [False, True], [True, False]):
        worlds.constraints[0].enable(holds)
        worlds.step()
        first, second, third = islands[:, rows].T
        assert ((first == second) == holds).all()
        assert (third != second).all()
