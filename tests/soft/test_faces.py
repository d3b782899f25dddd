"""Faces of soft bodies against shapes that come between their nodes, both ways and with friction."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np
import pytest
from tests.soft.scenes import GRAVITY, momentum, rigid, world

from carom import World
from carom.description import (
    Box,
    Capsule,
    ConvexHull,
    Cylinder,
    Geometry,
    Heightfield,
    Sphere,
    TriangleMesh,
)
from carom.scene.soft_body import SoftBody

_NORMAL_FORCE = 8
# A peg whose top is at z = 0.1, narrower than the cells of the cloth.
PEG = np.array([[x, y, z] for x in (-0.01, 0.01) for y in (-0.01, 0.01) for z in (-0.1, 0.1)])
SPIKE = TriangleMesh(
    np.array([[0.0, 0.0, 0.1], [0.05, 0.0, -0.1], [-0.03, 0.04, -0.1], [-0.03, -0.04, -0.1]]),
    np.array([[0, 1, 2], [0, 2, 3], [0, 3, 1], [1, 3, 2]], dtype=np.int32),
)
HILL = np.zeros((5, 5))
HILL[2, 2] = 1.0
SHAPES: dict[str, Geometry] = {
    "box": Box((0.01, 0.01, 0.1)),
    "sphere": Sphere(0.1),
    "cylinder": Cylinder(0.01, 0.2),
    "capsule": Capsule(0.01, 0.18),
    "hull": ConvexHull(PEG),
    "mesh": SPIKE,
    "height field": Heightfield(HILL, (0.05, 0.05, 0.1), 0.0),
}


def coarse_cloth(where: World, height: float, friction: float = 0.5) -> SoftBody:
    """Cloth with a node every 40 cm; the middle of a face is at the origin."""
    cloth = where.load_cloth((0.8, 0.8), (2, 2), (0, 0, 0), mass=0.09, friction=friction, margin=0.01)
    face = cloth.nodes[cloth.soft_spec.faces[0]].mean(axis=0)
    cloth.set_nodes(cloth.nodes - face + (0.0, 0.0, height))
    return cloth


def normal_forces(columns: Iterable[Any]) -> list[float]:
    """The normal force of each contact [N], from the columns of a query."""
    return list(list(columns)[_NORMAL_FORCE])


@pytest.mark.parametrize("kind", SHAPES)
def test_a_face_stays_above_what_is_between_its_nodes(kind: str) -> None:
    where = world()
    rigid(where, SHAPES[kind])
    cloth = coarse_cloth(where, 0.15)
    corners = cloth.soft_spec.faces[0]
    for _ in range(10):
        where.step(6)
        a, b, c = cloth.nodes[corners]
        normal = np.cross(b - a, c - a)
        # Height of the face's plane above the origin.
        assert a @ normal / normal[2] > 0.1


def test_what_falls_on_a_face_gets_the_impulse_that_the_face_loses() -> None:
    where = world(0.0)
    cloth = coarse_cloth(where, 0.0)
    ball = rigid(where, Sphere(0.02), 0.2, (0.0, 0.0, -0.2))
    ball.set_base_velocity((0.0, 0.0, 2.0), (0.0, 0.0, 0.0))
    where.step(60)
    rows = slice(ball.first_velocity + 3, ball.first_velocity + 6)
    assert momentum(cloth)[2] > 0.05
    assert momentum(cloth) + 0.2 * where.velocity[rows] == pytest.approx([0.0, 0.0, 0.4], abs=1e-9)


def test_what_lies_on_coarse_cloth_is_carried() -> None:
    where = world()
    cloth = coarse_cloth(where, 0.0, friction=1.0)
    for node in range(len(cloth.nodes)):
        cloth.anchor(node)
    block = rigid(where, Box((0.02, 0.02, 0.02)), 0.1, (0.0, 0.0, 0.05), friction=1.0)
    where.step(240)
    assert where.position[block.first_position + 2] == pytest.approx(0.03, abs=2e-3)
    _, columns = where.queries().contact_columns(block.id, -1, cloth.id, -1, where.parameters.time_step)
    assert sum(normal_forces(columns)) == pytest.approx(0.1 * GRAVITY, rel=0.05)


def test_an_anchored_face_leaves_the_body_that_it_is_anchored_to_alone() -> None:
    where = world(0.0)
    cloth = coarse_cloth(where, 0.0)
    block = rigid(where, Box((0.02, 0.02, 0.02)), 0.1)
    cloth.anchor(int(cloth.soft_spec.faces[0][0]), block)
    where.step(10)
    assert np.abs(cloth.node_velocities).max() < 1e-9


def test_faces_behind_touches_of_nodes_change_nothing() -> None:
    """Cloth inside the top of a box rests on its nodes: the faces between them are in the same plane."""
    where = world()
    rigid(where, Box((0.3, 0.3, 0.1)))
    cloth = where.load_cloth((0.4, 0.4), (4, 4), (0, 0, 0.13), margin=0.02, damping=0.5)
    where.step(60)
    found, columns = where.queries().contact_columns(cloth.id, -1, -1, -2, where.parameters.time_step)
    assert found == len(cloth.nodes)
    assert sum(normal_forces(columns)) > 0.0
