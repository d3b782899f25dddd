"""The neighbour list: it lasts as long as it may, and the pairs never depend on when it was made."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.collision.scene import NEAR, Scene, box, plane, sphere
from tests.physics.contact_scenes import HALF, add_ball, add_box, add_floor, earth
from tests.thorough.profiles import cases

from carom.layouts.contacts import FEW_SHAPES, KNOWN, LIST_AGE, LIST_KIND, LISTED, PAIRS
from carom.layouts.model import EVERY_SHAPE

SLACK = 0.02


def counts(scene: Scene) -> np.ndarray:
    return scene.numpy("pairs")["count_pairs"][0]


def near_pairs(scene: Scene) -> dict[tuple[int, int], int]:
    """The pairs selected, with how near they are."""
    arrays, count = scene.numpy("pairs"), counts(scene)[PAIRS]
    pairs = map(tuple, arrays["pair_shapes"][0, :count].tolist())
    return dict(zip(pairs, arrays["pair_nearness"][0, :count].tolist(), strict=True))


def moving_scene(count: int, seed: int) -> tuple[Scene, np.ndarray]:
    """Shapes of several sizes over a plane, crowded."""
    rng = np.random.default_rng(seed)
    places = rng.uniform(0.0, 1.0, (count, 3))
    shapes = [
        sphere(radius, position=place) if place[0] < 0.5 else box([radius] * 3, position=place)
        for radius, place in zip(rng.uniform(0.02, 0.2, count), places, strict=True)
    ]
    return Scene([plane(), *shapes], pair_room=count * count + count, contact_room=4000), places


@settings(max_examples=cases(40), deadline=None)
@given(
    seed=st.integers(0, 2**32 - 1),
    count=st.integers(2, 60),
    speeds=st.lists(st.sampled_from([0.0, 1e-4, 1e-3, 4e-3, 0.011, 0.3]), min_size=1, max_size=25),
    ahead=st.sampled_from([0, 1, EVERY_SHAPE]),
)
def test_pairs_are_those_of_a_list_that_is_made_anew(seed, count, speeds, ahead):
    rng = np.random.default_rng(seed)
    scene, places = moving_scene(count, seed)
    scene.settings.looks_ahead = ahead
    if ahead == 1:
        scene.numpy("shapes")["shape_ccd_radius"][1::3] = 0.001
    for speed in speeds:
        places += rng.uniform(-speed, speed, places.shape)
        fresh, _ = moving_scene(count, seed)
        fresh.settings.looks_ahead = scene.settings.looks_ahead
        fresh.numpy("shapes")["shape_ccd_radius"][:] = scene.numpy("shapes")["shape_ccd_radius"]
        # Where links were, and which shapes are not new.
        fresh.numpy("scratch")["link_pose"][:] = scene.numpy("scratch")["link_pose"]
        fresh.numpy("contacts")["count_contacts"][0, KNOWN] = scene.numpy("contacts")["count_contacts"][
            0, KNOWN
        ]
        for one in (scene, fresh):
            for row, place in enumerate(places, start=1):
                one.place(row, place)
            one.collide()
        assert near_pairs(scene) == near_pairs(fresh)


def test_a_list_lasts_where_shapes_look_farther_ahead_from_step_to_step():
    scene = Scene([sphere(0.1), sphere(0.1, position=(1.0, 0.0, 0.0))])
    scene.settings.looks_ahead = EVERY_SHAPE
    place = 0.0
    for step in range(8):
        scene.numpy("scratch")["link_pose"][0, 0, 0] = place
        place += 1e-5 * step
        scene.place(0, (place, 0.0, 0.0))
        scene.collide()
    assert counts(scene)[LIST_AGE] >= 5


def test_a_list_lasts_while_no_shape_has_moved_by_half_its_slack():
    scene = Scene([sphere(0.1), sphere(0.1, position=(0.2 + NEAR + 0.9 * SLACK, 0.0, 0.0))])
    for _ in range(2):
        scene.collide()
    # The first list is without slack, as no speed is known.
    assert counts(scene)[LIST_KIND] == 0
    scene.place(0, (1e-6, 0.0, 0.0))
    scene.collide()
    assert (counts(scene)[LIST_KIND], counts(scene)[LISTED], counts(scene)[PAIRS]) == (1, 1, 0)
    scene.place(0, (0.49 * SLACK, 0.0, 0.0))
    scene.place(1, (0.2 + NEAR + 0.42 * SLACK, 0.0, 0.0))
    scene.collide()
    assert (counts(scene)[LIST_AGE], counts(scene)[PAIRS]) == (1, 1)
    scene.place(0, (0.52 * SLACK, 0.0, 0.0))
    scene.collide()
    assert counts(scene)[LIST_AGE] == 0


def kinds_by_speed(scene: Scene) -> list[int]:
    """The kind of the list while a shape moves fast, then slowly, then fast again."""
    kinds = []
    for step, speed in enumerate([0.003] * 5 + [0.002] * 3 + [0.003] * 3):
        scene.place(0, (speed * step, 0.0, 0.0))
        scene.collide()
        kinds.append(int(counts(scene)[LIST_KIND]))
    return kinds


def test_many_fast_shapes_have_no_list_with_slack_until_they_are_slow():
    others = [sphere(0.1, position=(0.3 + 0.5 * i, 0.0, 0.0)) for i in range(FEW_SHAPES)]
    kinds = kinds_by_speed(Scene([sphere(0.1), *others]))
    assert kinds[:5] == [0] * 5
    assert 1 in kinds[5:]


def test_few_fast_shapes_have_a_list_of_all_pairs():
    scene = Scene([sphere(0.1), sphere(0.1, position=(0.3, 0.0, 0.0)), sphere(0.1, position=(9.0, 0.0, 0.0))])
    assert kinds_by_speed(scene) == [0] + [2] * 10
    scene.place(0, (8.9, 0.0, 0.0))
    scene.collide()
    assert (counts(scene)[LIST_AGE], counts(scene)[LISTED], counts(scene)[PAIRS]) == (10, 3, 1)
    # After a while it is made anew, with as much slack as the speed meanwhile would have needed.
    scene.place(0, (0.03, 0.0, 0.0))
    for _ in range(260):
        scene.collide()
    assert counts(scene)[LIST_KIND] == 1


def test_a_list_that_has_no_room_for_slack_has_none():
    places = [(0.2 * i + 0.05 * i, 0.0, 0.0) for i in range(40)]
    scene = Scene([sphere(0.1, position=place) for place in places], pair_room=1)
    assert scene.tables["pairs"].capacity["listed"] < 39
    for _ in range(3):
        scene.place(0, (1e-6, 0.0, 0.0))
        scene.collide()
    assert counts(scene)[LIST_KIND] == 0
    assert near_pairs(scene) == {}


@pytest.mark.parametrize("change", ["filter", "group", "mode", "body", "removal", "fixed"])
def test_what_may_collide_is_asked_again_when_it_changes(change: str) -> None:
    world = earth()
    add_floor(world)
    lower, upper = add_box(world, (0.0, 0.0, HALF)), add_box(world, (0.0, 0.0, 3.0 * HALF))
    world.step(10)
    assert world.contact_arrays.contact_count == 8
    shapes = world.contact_arrays.shapes
    match change:
        case "filter":
            shapes.filters.set(lower.rows.first["link"], upper.rows.first["link"], enabled=False)
            world.scene_changed()
        case "group":
            shapes.set_group_and_mask(lower.rows.first["link"], 1, 1)
            shapes.set_group_and_mask(upper.rows.first["link"], 2, 2)
            world.scene_changed()
        case "mode":
            # It collides with others only if one mask is enough.
            shapes.set_group_and_mask(upper.rows.first["link"], 1, 0)
            world.parameters.collision_filter_mode = 1
            world.scene_changed()
            # Until the list has slack again.
            world.step(5)
            assert world.contact_arrays.contact_count == 8
            world.parameters.collision_filter_mode = 0
            world.apply_parameters()
        case "body":
            add_ball(world, (5.0, 0.0, HALF - 0.001))
        case "removal":
            world.remove(lower.id)
        case "fixed":
            lower.change_dynamics(-1, mass=0.0)
    world.step()
    expected = {"filter": 4, "group": 4, "mode": 4, "body": 9, "removal": 0, "fixed": 4}
    assert world.contact_arrays.contact_count == expected[change]
