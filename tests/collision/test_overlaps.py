"""Overlaps and their two orders, against a model of Bullet's pair cache and against orders of PyBullet.

`getContactPoints` of PyBullet lists manifolds in their order, so the orders written here are from there.
"""

from __future__ import annotations

import numpy as np
import pytest
from tests.collision.scene import NEAR
from tests.physics.contact_scenes import HALF, add_box, add_floor, earth

from carom import World
from carom.layouts.contacts import OVERLAPS
from carom.model.overlap_order import without_overlaps

Pair = tuple[int, int]
UNTURNED = (0.0, 0.0, 0.0, 1.0)


def overlaps_of(world: World) -> np.ndarray:
    """The overlaps of a world: shapes, places in the pair cache and among manifolds, shape (n, 4)."""
    contacts = world.contact_arrays.contacts.numpy
    columns = [contacts[f"overlap_{name}"][0] for name in ("shapes", "place", "manifold")]
    return np.column_stack(columns)[: contacts["count_contacts"][0, OVERLAPS]]


def manifolds_of(world: World) -> list[Pair]:
    """The overlaps of a world, as pairs of shapes, in order of manifolds."""
    rows = overlaps_of(world)
    return [(int(a), int(b)) for a, b in rows[np.argsort(rows[:, 3]), :2]]


def cached(world: World) -> list[Pair]:
    """The overlaps of a world, as pairs of shapes, in the order of the pair cache."""
    rows = overlaps_of(world)
    return [(int(a), int(b)) for a, b in rows[np.argsort(rows[:, 2]), :2]]


def on_floor(world: World) -> list[int]:
    """The shapes that overlap shape 0, in order of manifolds."""
    return [b for a, b in manifolds_of(world) if a == 0]


def place(world: World, body: int, position: tuple[float, float, float]) -> None:
    """Put a body somewhere, unturned."""
    world.bodies[body].set_inertial_pose(position, UNTURNED)


class Cache:
    """The pair cache and the manifolds of boxes that do not turn, by Bullet's rules."""

    def __init__(self) -> None:
        self.pairs: list[Pair] = []
        self.manifolds: list[Pair] = []

    def step(self, found: list[Pair], overlapping: set[Pair]) -> None:
        """One substep: pairs found, in order; then those that have parted lose their places."""
        self.pairs += found
        place = 0
        while place < len(self.pairs):
            pair = self.pairs[place]
            if pair in overlapping:
                place += 1
                continue
            self.pairs[place] = self.pairs[-1]
            self.pairs.pop()
            if pair in self.manifolds:
                self.manifolds[self.manifolds.index(pair)] = self.manifolds[-1]
                self.manifolds.pop()
        self.manifolds += [pair for pair in self.pairs if pair not in self.manifolds]


def row_of_cubes(gap: float = 1e-4) -> World:
    """Four cubes side by side on a floor."""
    world = earth()
    add_floor(world)
    for i in range(4):
        add_box(world, (4.0 * HALF * i, 0.0, HALF - gap))
    world.step()
    return world


def test_a_cube_that_leaves_and_comes_back_is_last_and_the_last_takes_its_place():
    world = row_of_cubes()
    assert on_floor(world) == [1, 2, 3, 4]
    place(world, 1, (0.0, 0.0, HALF + 0.05))
    world.step()
    assert on_floor(world) == [4, 2, 3]
    place(world, 1, (0.0, 0.0, HALF))
    world.step()
    assert on_floor(world) == [4, 2, 3, 1]


def test_a_cube_that_is_lifted_by_less_than_the_gap_of_bounds_stays():
    world = row_of_cubes()
    place(world, 1, (0.0, 0.0, HALF + 0.02))
    world.step()
    assert on_floor(world) == [1, 2, 3, 4]


def test_a_removed_body_is_replaced_by_the_last():
    world = row_of_cubes()
    world.remove(2)
    assert on_floor(world) == [1, 3, 2]
    world.step()
    assert on_floor(world) == [1, 3, 2]
    add_box(world, (4.0 * HALF, 0.0, HALF))
    world.step()
    assert on_floor(world) == [1, 3, 2, 4]


def test_layers_of_a_new_scene_are_found_in_the_order_of_the_tree_of_bounds():
    """27 cubes with gaps of 5 mm: the bottom ones meet the floor in PyBullet's order."""
    world = earth()
    add_floor(world)
    edge = 2.0 * HALF + 0.005
    for x in range(3):
        for y in range(3):
            for z in range(3):
                add_box(world, (x * edge, y * edge, HALF + 0.005 + z * edge))
    world.step()
    assert on_floor(world) == [25, 16, 7, 22, 13, 4, 19, 10, 1]


@pytest.mark.parametrize("seed", range(6))
def test_orders_are_those_of_a_pair_cache_however_boxes_come_and_go(seed: int):
    """Boxes without velocities: the lower one of a pair finds the other, those with later boxes first."""
    random = np.random.default_rng(seed)
    world = World()
    places = random.uniform(-0.5, 0.5, (8, 3))
    boxes = [add_box(world, position) for position in places]
    world.step()
    cache = Cache()
    cache.manifolds = manifolds_of(world)
    cache.pairs = cached(world)
    for _ in range(40):
        for moved in random.choice(len(boxes), 2, replace=False):
            places[moved] = random.uniform(-0.5, 0.5, 3)
        for box, position in zip(boxes, places, strict=True):
            box.set_inertial_pose(position, UNTURNED)
            box.set_base_velocity((0.0, 0.0, 0.0), (0.0, 0.0, 0.0))
        world.detect_collisions()
        near = (np.abs(places[:, None] - places[None]) <= 2.0 * HALF + NEAR).all(axis=2)
        overlapping = {(int(a), int(b)) for a, b in np.argwhere(near) if a < b}
        found = overlapping - set(cache.pairs)
        cache.step(sorted(found, key=lambda pair: (pair[0], -pair[1])), overlapping)
        assert manifolds_of(world) == cache.manifolds
        assert cached(world) == cache.pairs
        assert overlaps_of(world)[:, :2].tolist() == sorted(list(pair) for pair in overlapping)


def test_overlaps_that_remain_keep_their_order():
    overlaps = np.array(
        [[0, 1, 0, 3, 5], [0, 2, 3, 1, 6], [0, 3, 1, 0, 7], [1, 2, 2, 2, 8]],
        dtype=np.int32,
    )
    columns = overlaps[:, :2], overlaps[:, 2], overlaps[:, 3], [overlaps[:, 4]]

    def left(*shapes: int) -> list[list[int]]:
        return np.column_stack(without_overlaps(*columns, shapes)).tolist()

    # Pair cache: 01 03 12 02; without those of 1: 02 03. Manifolds: 03 02 12 01; without those of 1: 03 02.
    assert left(1) == [[0, 2, 0, 1, 6], [0, 3, 1, 0, 7]]
    assert left(4, 5) == overlaps.tolist()
    assert left() == overlaps.tolist()


def test_a_snapshot_keeps_the_order():
    world = row_of_cubes()
    place(world, 1, (0.0, 0.0, HALF + 0.05))
    world.step()
    place(world, 1, (0.0, 0.0, HALF))
    world.step()
    saved = world.snapshot()
    again = world.copy()
    for _ in range(20):
        world.step()
    place(world, 3, (0.0, 0.0, 2.0))
    world.step()
    world.restore(saved)
    for _ in range(20):
        world.step()
        again.step()
    assert manifolds_of(world) == manifolds_of(again)
    np.testing.assert_array_equal(world.position, again.position)


def test_a_step_that_is_repeated_with_longer_arrays_has_the_same_order():
    """Arrays have room for 16 overlaps at first: a scene of more has to be stepped twice."""
    worlds = []
    for room in (0, 500):
        world = earth()
        add_floor(world)
        world.contact_arrays.contacts.reserve({"contact": room, "overlap": room})
        for i in range(40):
            add_box(world, (0.21 * (i % 7), 0.21 * (i // 7), HALF))
        for _ in range(3):
            world.step()
        worlds.append(world)
    assert manifolds_of(worlds[0]) == manifolds_of(worlds[1])
    np.testing.assert_array_equal(worlds[0].position, worlds[1].position)
