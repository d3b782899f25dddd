"""The pairs of the broad phase against comparing every shape with every other, and the filters."""

import itertools

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.collision.scene import Scene, box, plane, sphere
from tests.thorough.profiles import cases

from carom.layouts.flags import LoadFlags
from carom.model.shape_arrays import FIXED_GROUP, FIXED_MASK


def brute_force_pairs(scene: Scene, count: int, max_distance: float) -> list[tuple[int, int]]:
    arrays = scene.numpy("pairs")
    lower, upper = arrays["shape_lower"][0], arrays["shape_upper"][0]
    return [
        (a, b)
        for a, b in itertools.combinations(range(count), 2)
        if (lower[a] <= upper[b] + max_distance).all() and (lower[b] <= upper[a] + max_distance).all()
    ]


@settings(max_examples=cases(25), deadline=None)
@given(
    seed=st.integers(0, 2**32 - 1),
    count=st.integers(1, 120),
    spread=st.sampled_from([0.0, 1.0, 5.0, 1e3]),
    sizes=st.sampled_from([(0.3, 0.3), (0.01, 2.0), (0.5, 100.0)]),
    flat=st.booleans(),
)
def test_pairs_are_those_whose_bounds_meet(seed, count, spread, sizes, flat):
    rng = np.random.default_rng(seed)
    positions = rng.normal(size=(count, 3)) * spread * (1, 1, not flat)
    radii = rng.uniform(*sizes, size=count)
    shapes = [sphere(r, position=p, breaking=0.1) for r, p in zip(radii, positions, strict=True)]
    scene = Scene(shapes, pair_room=count * count)
    scene.settings.near = 0.1
    scene.collide()
    assert scene.pairs == brute_force_pairs(scene, count, 0.1)


@settings(max_examples=cases(25), deadline=None)
@given(seed=st.integers(0, 2**32 - 1), count=st.integers(3, 60))
def test_pairs_do_not_depend_on_those_of_the_step_before(seed, count):
    rng = np.random.default_rng(seed)
    scene = Scene(
        [sphere(0.5, breaking=0.1) for _ in range(count)], pair_room=count * count, contact_room=4000
    )
    scene.settings.near = 0.1
    for _ in range(6):
        for row in range(count):
            scene.place(row, rng.uniform(-2, 2, size=3))
        scene.collide()
        assert scene.pairs == brute_force_pairs(scene, count, 0.1)


def test_bodies_that_fell_far_away_or_are_nowhere_do_not_disturb_the_others():
    rng = np.random.default_rng(3)
    positions = rng.uniform(0, 10, (200, 3))
    positions[::17] *= 1e7
    positions[5::31] = np.nan
    positions[6::31] = np.inf
    scene = Scene([plane(), *(sphere(0.5, position=p) for p in positions)], pair_room=4000)
    scene.collide()
    finite: list[bool] = [bool(np.isfinite(position).all()) for position in positions]
    expected = [
        (a, b) for a, b in brute_force_pairs(scene, 201, 0.02) if a > 0 and finite[a - 1] and finite[b - 1]
    ]
    assert [pair for pair in scene.pairs if pair[0] > 0] == expected
    assert expected
    assert np.isfinite(scene.contacts("distance")).all()
    # Not all in one leaf: neighbours in the order are near each other.
    order = scene.numpy("pairs")["shape_order"][0, : scene.numpy("pairs")["count_pairs"][0, 2]]
    near = [i for i in order if np.abs(positions[i - 1]).max() < 20]
    steps = np.linalg.norm(np.diff(positions[np.array(near) - 1], axis=0), axis=1)
    assert np.median(steps) < 3.0


def test_a_plane_meets_what_reaches_below_it_at_any_angle():
    tilted = plane(np.array([1.0, 0, 1]) / np.sqrt(2))
    inside = sphere(0.5, position=(-1, 0, 1.3))
    outside = sphere(0.5, position=(2, 0, 2))
    scene = Scene([outside, tilted, inside])
    scene.collide()
    assert scene.pairs == [(1, 2)]


def two_spheres() -> Scene:
    return Scene([sphere(0.5), sphere(0.5, position=(0.5, 0, 0))])


@pytest.mark.parametrize(
    ("a", "b", "either", "both"),
    [
        ((1, -1), (1, -1), True, True),
        ((1, 1), (2, 2), False, False),
        ((1, 2), (2, 0), True, False),
        ((1, 2), (2, 1), True, True),
        ((0, -1), (1, 0), True, False),
    ],
)
def test_groups_and_masks(a, b, either, both):
    scene = two_spheres()
    arrays = scene.numpy("shapes")
    arrays["link_group"][:2], arrays["link_mask"][:2] = (a[0], b[0]), (a[1], b[1])
    for mode, expected in ((0, either), (1, both)):
        scene.settings.filter_both = mode
        scene.collide()
        assert bool(scene.pairs) == expected


def test_pair_filters_decide_whatever_the_masks():
    scene = Scene([sphere(0.5, position=(0.1 * i, 0, 0)) for i in range(4)])
    arrays = scene.numpy("shapes")
    pairs = [(0, 1, 0), (0, 3, 1), (2, 3, 1)]
    scene.tables["shapes"].reserve({"filter": len(pairs)})
    for i, (a, b, enabled) in enumerate(pairs):
        arrays["filter_link_a"][i], arrays["filter_link_b"][i] = a, b
        arrays["filter_enabled"][i] = enabled
    scene.settings.filter_count = len(pairs)
    arrays["link_group"][3] = arrays["link_mask"][3] = 0
    scene.collide()
    assert scene.pairs == [(0, 2), (0, 3), (1, 2), (2, 3)]


def test_fixed_bases_do_not_touch_each_other_by_their_groups():
    scene = Scene([plane(), box((1, 1, 1), static=True), sphere(1)])
    scene.numpy("shapes")["link_group"][:2] = FIXED_GROUP
    scene.numpy("shapes")["link_mask"][:2] = FIXED_MASK
    scene.collide()
    assert scene.pairs == [(0, 2), (1, 2)]


def chain(flags: LoadFlags) -> Scene:
    """Four links 0 - 1 - 2 - 3 of one body, all at one place; the joint of link 3 is fixed."""
    scene = Scene([sphere(0.5) for _ in range(4)])
    scene.numpy("shapes")["shape_tree"][:4] = 0
    scene.numpy("shapes")["link_self_collision"][:4] = int(flags)
    scene.numpy("model")["link_parent"][:4] = (-1, 0, 1, 2)
    scene.numpy("model")["link_dof_count"][:4] = (6, 1, 1, 0)
    scene.collide()
    return scene


@pytest.mark.parametrize(
    ("flags", "expected"),
    [
        (LoadFlags.NONE, []),
        (LoadFlags.USE_SELF_COLLISION, [(0, 2), (0, 3), (1, 3)]),
        (
            LoadFlags.USE_SELF_COLLISION | LoadFlags.USE_SELF_COLLISION_EXCLUDE_PARENT,
            [(0, 2), (0, 3), (1, 3)],
        ),
        (
            LoadFlags.USE_SELF_COLLISION | LoadFlags.USE_SELF_COLLISION_INCLUDE_PARENT,
            [(0, 1), (0, 2), (0, 3), (1, 2), (1, 3)],
        ),
        (LoadFlags.USE_SELF_COLLISION | LoadFlags.USE_SELF_COLLISION_EXCLUDE_ALL_PARENTS, []),
    ],
)
def test_links_of_one_body(flags, expected):
    """The pair (2, 3) is rigid and never touches."""
    assert chain(flags).pairs == expected
