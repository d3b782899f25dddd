"""Rays against closed forms and against what PyBullet reports."""

import json
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose
from tests.collision.scene import (
    Scene,
    box,
    capsule,
    cylinder,
    height_field,
    hull,
    plane,
    sphere,
    triangles,
)

RECORD = json.loads(Path(__file__).with_name("rays.json").read_text(encoding="utf-8"))
CORNERS = [[x, y, z] for x in (-0.2, 0.2) for y in (-0.3, 0.3) for z in (-0.1, 0.1)]
TENT = [[-1, -1, 0], [1, -1, 0], [1, 1, 0.2], [-1, 1, 0], [0, 0, 0.5]]
TENT_FACES = [[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]]
MAKERS = {
    "sphere": lambda **at: sphere(0.3, **at),
    "box": lambda **at: box((0.2, 0.3, 0.1), **at),
    "capsule": lambda **at: capsule(0.2, 0.3, **at),
    "cylinder": lambda **at: cylinder(0.2, 0.3, **at),
    "hull": lambda **at: hull(CORNERS, margin=0.001, **at),
    "plane": plane,
    "mesh": lambda **at: triangles(TENT, TENT_FACES, **at),
}


@pytest.mark.parametrize("name", MAKERS)
def test_hits_are_those_of_pybullet(name):
    """Its iterations end within a millimetre, so rays that graze a round shape may differ."""
    record = RECORD["shapes"][name]
    rays, hits = np.array(record["rays"]), np.array(record["hits"], dtype=float)
    scene = Scene([MAKERS[name](position=RECORD["position"], orientation=RECORD["orientation"])])
    shape, fraction, normal = scene.rays(rays[:, :3], rays[:, 3:])
    same = (shape >= 0) == (hits[:, 0] > 0)
    assert same.sum() >= len(rays) - 1
    both = same & (shape >= 0)
    assert both.sum() > 5
    assert_allclose(fraction[both], hits[both, 1], rtol=0, atol=2e-3)
    # On edges of the rounded hull and of PyBullet's polygonal caps normals differ.
    agreeing = np.abs(normal[both] - hits[both, 2:]).max(axis=1) < 0.02
    assert agreeing.mean() > 0.9


@pytest.mark.parametrize("name", ["sphere", "box", "capsule", "cylinder", "hull"])
def test_a_ray_from_inside_does_not_hit(name):
    shape, fraction, normal = Scene([MAKERS[name]()]).rays([0.01, 0.02, 0.03], [5, 4, 3])
    assert shape.tolist() == [-1]
    assert fraction.tolist() == [1.0]
    assert_allclose(normal, 0)


@pytest.mark.parametrize("name", MAKERS)
def test_a_ray_without_length_or_of_no_number_hits_nothing(name):
    scene = Scene([MAKERS[name]()])
    starts = [[0, 0, 1], [np.nan, 0, 1], [0, 0, np.inf]]
    shape, _, _ = scene.rays(starts, [[0, 0, 1], [0, 0, 0], [0, 0, -1]])
    assert shape.tolist() == [-1, -1, -1]


def test_hits_come_in_the_order_along_the_ray():
    scene = Scene([plane(), *(sphere(0.5, position=(0, 0, z)) for z in (7, 1, 4, 4))])
    found = [scene.rays([0, 0, 10], [0, 0, -10], hit_number=n) for n in range(6)]
    assert [shape[0] for shape, _, _ in found] == [1, 3, 4, 2, 0, -1]
    assert_allclose([fraction[0] for _, fraction, _ in found], [0.125, 0.275, 0.275, 0.425, 0.5, 1.0])


def test_hits_on_one_link_that_are_near_each_other_count_once():
    folded = [[-1, -1, 0], [1, -1, 0], [0, 1, 0], [-1, -1, -0.1], [1, -1, -0.1], [0, 1, -0.1]]
    scene = Scene([triangles(folded, [[0, 1, 2], [3, 4, 5]])])
    _, fraction, _ = scene.rays([0, 0, 1], [0, 0, -1], hit_number=1)
    assert_allclose(fraction, [0.55])
    shape, _, _ = scene.rays([0, 0, 1], [0, 0, -1], hit_number=1, separation=0.1)
    assert shape.tolist() == [-1]


@pytest.mark.parametrize(("group", "mask", "ray_mask", "hit"), [
    (1, -1, -1, True), (1, -1, 2, False), (2, -1, 2, True), (6, 1, 4, True), (1, 2, -1, False),
    (1, -1, 0, False),
])  # fmt: skip
def test_groups(group, mask, ray_mask, hit):
    scene = Scene([sphere(0.5)])
    scene.numpy("shapes")["link_group"][0] = group
    scene.numpy("shapes")["link_mask"][0] = mask
    shape, _, _ = scene.rays([0, 0, 5], [0, 0, -5], mask=ray_mask)
    assert (shape[0] == 0) == hit


def test_many_shapes_give_what_each_gives_alone():
    rng = np.random.default_rng(2)
    makers = list(MAKERS.values())
    shapes = []
    for i in range(120):
        turn = rng.normal(size=4)
        maker = makers[i % 5]
        shapes.append(maker(position=rng.uniform(-4, 4, 3), orientation=turn / np.linalg.norm(turn)))
    starts, ends = rng.uniform(-5, 5, (60, 3)), rng.uniform(-5, 5, (60, 3))
    shape, fraction, _ = Scene(shapes).rays(starts, ends)
    alone = np.array([Scene([one]).rays(starts, ends)[1] for one in shapes])
    assert_allclose(fraction, alone.min(axis=0), atol=1e-12)
    assert (shape >= 0).sum() > 10


def test_height_field_is_that_of_its_triangles():
    rng = np.random.default_rng(4)
    heights = rng.normal(size=(9, 13)) * 0.4
    field = height_field(heights, spacing=(0.5, 0.7))
    assert field.polyhedron is not None
    rows, columns = heights.shape
    faces = []
    for row in range(rows - 1):
        for column in range(columns - 1):
            a = row * columns + column
            faces += [(a, a + 1, a + columns), (a + 1, a + columns + 1, a + columns)]
    mesh = triangles(field.polyhedron.vertices, faces)
    starts = rng.uniform(-1, 1, (200, 3)) * (4, 4, 2) + (0, 0, 1)
    ends = rng.uniform(-1, 1, (200, 3)) * (4, 4, 2) - (0, 0, 1)
    ends[:20, :2] = starts[:20, :2]
    ends[20:40, 1] = starts[20:40, 1]
    by_field = Scene([field]).rays(starts, ends)
    by_mesh = Scene([mesh]).rays(starts, ends)
    assert (by_mesh[0] == 0).sum() > 50
    assert_allclose(by_field[1], by_mesh[1], atol=1e-12)
    assert_allclose(by_field[2], by_mesh[2], atol=1e-9)


def crowd_and_rays(count: int):
    """A hundred shapes of all kinds, and rays in all directions among them."""
    rng = np.random.default_rng(count)
    makers, shapes = list(MAKERS.values()), []
    for i in range(100):
        turn = rng.normal(size=4)
        maker = makers[i % len(makers)] if i < 20 else makers[i % 5]
        shapes.append(maker(position=rng.uniform(-2, 2, 3), orientation=turn / np.linalg.norm(turn)))
    return Scene(shapes), rng.uniform(-4, 4, (count, 3)), rng.uniform(-4, 4, (count, 3))


@pytest.mark.parametrize("count", [1, 2, 3, 4, 5, 7, 9, 30])
@pytest.mark.parametrize("hit_number", [0, 2])
def test_rays_do_not_mind_which_others_are_cast_with_them(count, hit_number):
    scene, starts, ends = crowd_and_rays(count)
    together = scene.rays(starts, ends, hit_number=hit_number)
    alone = [scene.rays(start, end, hit_number=hit_number) for start, end in zip(starts, ends, strict=True)]
    for mine, theirs in zip(together, zip(*alone, strict=True), strict=True):
        assert np.array_equal(mine, np.concatenate(theirs))


@pytest.mark.parametrize("bad", [0, 1, 2, 3, 6])
def test_a_ray_of_no_number_does_not_harm_its_neighbours(bad):
    scene, starts, ends = crowd_and_rays(7)
    others = np.arange(7) != bad
    expected = [values[others] for values in scene.rays(starts, ends)]
    starts[bad, 1], ends[bad, 0] = np.nan, np.inf
    shape, fraction, normal = scene.rays(starts, ends)
    assert (shape[bad], fraction[bad], *normal[bad]) == (-1, 1.0, 0.0, 0.0, 0.0)
    assert all(map(np.array_equal, (shape[others], fraction[others], normal[others]), expected))
