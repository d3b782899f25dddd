"""Soft bodies and what they touch: shapes of every kind, friction, links that are pushed, each other."""

from __future__ import annotations

import numpy as np
import pytest
from tests.soft.scenes import GRAVITY, momentum, rigid, world

from carom.description import (
    Box,
    Capsule,
    ConvexHull,
    Cylinder,
    Geometry,
    Heightfield,
    Plane,
    Sphere,
    TriangleMesh,
)
from carom.scene.soft_body import SoftBody

CUBE = np.array([[x, y, z] for x in (-0.3, 0.3) for y in (-0.3, 0.3) for z in (-0.1, 0.1)])
FLOOR = TriangleMesh(
    np.array([[-2.0, -2.0, 0.1], [2.0, -2.0, 0.1], [2.0, 2.0, 0.1], [-2.0, 2.0, 0.1]]),
    np.array([[0, 1, 2], [0, 2, 3]], dtype=np.int32),
)
TOPS: dict[str, tuple[Geometry, float]] = {
    "plane": (Plane(), 0.0),
    "box": (Box((0.3, 0.3, 0.1)), 0.1),
    "sphere": (Sphere(0.3), 0.3),
    "cylinder": (Cylinder(0.3, 0.2), 0.1),
    "capsule": (Capsule(0.2, 0.2), 0.3),
    "hull": (ConvexHull(CUBE), 0.1),
    "mesh": (FLOOR, 0.1),
    "height field": (Heightfield(np.full((9, 9), 1.0), (0.25, 0.25, 0.1), 0.0), 0.1),
}


@pytest.mark.parametrize("kind", TOPS)
def test_cloth_lies_on_a_shape_at_its_margin(kind: str) -> None:
    shape, top = TOPS[kind]
    where = world()
    rigid(where, shape)
    cloth = where.load_cloth((0.4, 0.4), (8, 8), (0, 0, top + 0.1), margin=0.02, friction=1.0, damping=0.5)
    where.step(480)
    middle = np.linalg.norm(cloth.nodes[:, :2], axis=1).argmin()
    assert cloth.nodes[middle, 2] == pytest.approx(top + 0.02, abs=0.003)
    assert np.abs(cloth.node_velocities).max() < 0.5


@pytest.mark.parametrize("kind", ["box", "sphere", "cylinder", "capsule", "hull"])
def test_no_node_ends_up_inside(kind: str) -> None:
    shape, top = TOPS[kind]
    where = world()
    body = rigid(where, shape)
    where.load_soft_solid((0.2, 0.2, 0.2), (3, 3, 3), (0.05, 0, top + 0.3), youngs_modulus=2e4)
    soft = where.bodies[body.id + 1]
    assert isinstance(soft, SoftBody)
    for _ in range(60):
        where.step(4)
        probes = [((x, y, z + 1e-6), (x, y, z - 1e-6)) for x, y, z in soft.nodes.tolist()]
        hits = where.queries().cast_rays([a for a, _ in probes], [b for _, b in probes])
        # The faces of the body itself are there, but no surface of the shape.
        assert body.id not in {hit[0] for hit in hits}


@pytest.mark.parametrize("friction", [0.0, 0.2, 1.0])
def test_it_slides_by_the_product_of_both_coefficients(friction: float) -> None:
    where = world()
    where.gravity = (2.0, 0.0, -GRAVITY)
    rigid(where, Plane(), friction=0.5)
    cloth = where.load_cloth(cells=(4, 4), position=(0, 0, 0.01), margin=0.01, friction=friction)
    where.step(240)
    assert cloth.nodes[:, 0].mean() == pytest.approx(max(0.0, 2.0 - 0.5 * friction * GRAVITY) / 2, abs=0.02)


def test_a_rigid_box_rests_on_a_soft_cube_which_bears_its_weight() -> None:
    where = world()
    rigid(where, Plane())
    cube = where.load_soft_solid((0.4, 0.4, 0.4), (3, 3, 3), (0, 0, 0.21), youngs_modulus=2e4, damping=0.05)
    block = rigid(where, Box((0.3, 0.3, 0.1)), 1.0, (0, 0, 0.55))
    where.step(960)
    height = where.position[block.first_position + 2]
    assert height == pytest.approx(cube.nodes[:, 2].max() + 0.005 + 0.1, abs=0.002)
    assert np.abs(where.velocity[block.first_velocity : block.first_velocity + 6]).max() < 0.01


def test_a_soft_cube_on_a_box_weighs_on_what_carries_the_box() -> None:
    where = world()
    rigid(where, Plane())
    block = rigid(where, Box((0.3, 0.3, 0.1)), 1.0, (0, 0, 0.1))
    where.load_soft_solid((0.2, 0.2, 0.2), (3, 3, 3), (0, 0, 0.32), mass=2.0, damping=0.05)
    where.step(480)
    contacts = where.contact_arrays.contacts.numpy
    count = where.contact_arrays.contact_count
    normal_force = contacts["contact_impulse"][0, :count, 0].sum() * 240.0
    assert normal_force == pytest.approx(3.0 * GRAVITY, rel=0.02)
    assert where.position[block.first_position + 2] == pytest.approx(0.1, abs=0.002)


def test_a_collision_keeps_momentum() -> None:
    where = world(0.0)
    cube = where.load_soft_solid((0.4, 0.4, 0.4), (3, 3, 3), mass=4.0, youngs_modulus=5e3)
    block = rigid(where, Box((0.1, 0.1, 0.1)), 1.0, (-1.0, 0.05, 0.0))
    block.set_base_velocity((3.0, 0.0, 0.0), (0.0, 0.0, 0.0))
    where.step(240)
    rows = slice(block.first_velocity + 3, block.first_velocity + 6)
    assert momentum(cube)[0] > 2.0
    assert momentum(cube) + where.velocity[rows] == pytest.approx([3.0, 0.0, 0.0], abs=1e-6)


def test_soft_bodies_rest_on_each_other() -> None:
    where = world()
    rigid(where, Plane())
    lower = where.load_soft_solid((0.4, 0.4, 0.4), (3, 3, 3), (0, 0, 0.21), youngs_modulus=5e4)
    upper = where.load_soft_solid((0.4, 0.4, 0.4), (3, 3, 3), (0, 0, 0.62), youngs_modulus=5e4)
    where.step(960)
    assert upper.nodes[:, 2].min() > lower.nodes[:, 2].max()
    assert abs(upper.nodes[:, 0].mean()) < 0.01
    assert np.abs(upper.node_velocities).max() < 0.02


@pytest.mark.parametrize("self_collision", [False, True])
def test_folded_cloth_lies_on_itself_if_that_is_asked_for(self_collision: bool) -> None:
    where = world()
    rigid(where, Plane())
    cloth = where.load_cloth((0.4, 0.4), (8, 8), bending=0.0, damping=0.5, self_collision=self_collision)
    folded = cloth.nodes.copy()
    # The half with positive x lies above the other one.
    folded[:, 2] = np.where(folded[:, 0] > 0.01, 0.06, 0.01)
    folded[:, 0] = -np.abs(folded[:, 0])
    above = folded[:, 2] > 0.03
    cloth.set_nodes(folded)
    where.step(720)
    free = above & (np.abs(folded[:, 0]) > 0.1)
    assert (cloth.nodes[free, 2].min() > 0.017) == self_collision


def test_filters_hold_for_soft_bodies() -> None:
    where = world()
    floor = rigid(where, Plane())
    cloth = where.load_cloth(cells=(2, 2), position=(0, 0, 0.1))
    where.contact_arrays.shapes.filters.set(floor.first_link, cloth.first_link, enabled=False)
    where.scene_changed()
    where.step(120)
    assert cloth.nodes[:, 2].max() < -0.5


def test_an_anchored_link_feels_the_pull() -> None:
    """A box hangs by a cloth that hangs in the world."""
    where = world()
    cloth = where.load_cloth((0.4, 0.4), (4, 4), orientation=(np.sqrt(0.5), 0, 0, np.sqrt(0.5)), damping=1.0)
    block = rigid(where, Box((0.05, 0.05, 0.05)), 0.5, (0, 0, -0.3))
    lowest = np.flatnonzero(cloth.nodes[:, 2] < -0.19)
    for node in np.flatnonzero(cloth.nodes[:, 2] > 0.19):
        cloth.anchor(int(node))
    for node in lowest:
        cloth.anchor(int(node), block)
    where.step(1920)
    assert np.abs(where.velocity[block.first_velocity : block.first_velocity + 6]).max() < 0.1
    # Without the cloth it would have fallen 320 m.
    assert -1.5 < where.position[block.first_position + 2] < -0.3
    center = where.position[block.first_position :][:3]
    assert cloth.nodes[lowest].mean(axis=0) - center == pytest.approx([0, 0, 0.1], abs=0.02)


def test_a_released_node_falls() -> None:
    where = world()
    rope = where.load_rope()
    anchor = rope.anchor(0)
    where.step(24)
    assert rope.nodes[0] == pytest.approx([-0.5, 0, 0], abs=1e-12)
    rope.release(anchor)
    where.step(240)
    assert rope.nodes[0, 2] < -1.0
