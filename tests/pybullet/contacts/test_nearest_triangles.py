"""Nearest points on meshes where several triangles are equally near, as at their corners."""

from __future__ import annotations

import pytest

import pybullet as p

CORNERS = [[0.1, 0, -0.1], [-0.1, 0.1, -0.1], [-0.1, -0.1, -0.1], [0, 0, 0.1]]
TRIANGLES = [0, 1, 2, 0, 3, 1, 1, 3, 2, 2, 3, 0]
# Of PyBullet 3.2.7: where the capsule is, the points on both, the normal, the distance.
NEAREST = [
    (
        [-0.07, 0.27, -0.33],
        [-0.07601445204823469, 0.23591810506000344, -0.24391328771059184],
        [-0.0998797109590353, 0.10068163789879994, -0.10072173424578817],
        [0.12028904096469382, 0.6816378987999318, -0.7217342457881629],
        0.19839927826679848,
    ),
    (
        [-0.24, -0.2, 0.05],
        [-0.20482367646592756, -0.1748740546185197, -0.02512594538148029],
        [-0.10070352647068145, -0.10050251890762961, -0.09949748109237039],
        [-0.7035264706814485, -0.5025189076296062, 0.5025189076296062],
        0.14799748742132396,
    ),
]


@pytest.mark.parametrize(("place", "on_a", "on_b", "normal", "distance"), NEAREST)
def test_points_are_those_of_a_triangle_that_is_as_near_as_the_one_before(
    place: list[float], on_a: list[float], on_b: list[float], normal: list[float], distance: float
) -> None:
    client = p.connect(p.DIRECT)
    mesh = p.createCollisionShape(p.GEOM_MESH, vertices=CORNERS, indices=TRIANGLES)
    capsule = p.createCollisionShape(p.GEOM_CAPSULE, radius=0.05, height=0.1)
    a, b = p.createMultiBody(1, capsule, -1, place), p.createMultiBody(0, mesh)
    nearest = min(p.getClosestPoints(a, b, 5), key=lambda point: point[8])
    p.disconnect(client)
    assert nearest[5] == pytest.approx(on_a, abs=1e-12)
    assert nearest[6] == pytest.approx(on_b, abs=1e-12)
    assert nearest[7] == pytest.approx(normal, abs=1e-12)
    assert nearest[8] == pytest.approx(distance, abs=1e-12)
