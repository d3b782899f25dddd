"""The inertia of a new mass heeds the margin that `changeDynamics` gave to a hull; values are PyBullet's."""

from __future__ import annotations

from typing import Any

import pytest

import pybullet as p

CORNERS = [[0.1, 0, 0], [-0.1, 0, 0], [0, 0.2, 0], [0, -0.2, 0], [0, 0, 0.3], [0, 0, -0.3]]
CUBE = """
v -1 -1 -1\nv 1 -1 -1\nv 1 1 -1\nv -1 1 -1\nv -1 -1 1\nv 1 -1 1\nv 1 1 1\nv -1 1 1
f 1 3 2\nf 1 4 3\nf 5 6 7\nf 5 7 8\nf 1 2 6\nf 1 6 5\nf 2 3 7\nf 2 7 6\nf 3 4 8\nf 3 8 7\nf 4 1 5\nf 4 5 8
"""
ROBOT = """<robot name="cube"><link name="cube"><inertial><mass value="2"/>
<inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>
<collision><geometry><mesh filename="cube.obj" scale="0.1 0.2 0.3"/></geometry></collision></link></robot>"""
HULL = {
    0.0: [0.04366733, 0.03360067, 0.01686733],
    0.01: [0.05062733, 0.03922733, 0.02116067],
    0.05: [0.08380066, 0.06706733, 0.04366733],
}
OBJ = {
    0.0: [0.04400267, 0.03386933, 0.01706933],
    0.01: [0.04742933, 0.03662933, 0.01916267],
    0.05: [0.06246933, 0.04900267, 0.02886933],
}


def inertia(body: int, margin: float) -> Any:
    p.changeDynamics(body, -1, collisionMargin=margin)
    p.changeDynamics(body, -1, mass=1)
    return p.getDynamicsInfo(body, -1)[2]


@pytest.mark.parametrize(("margin", "moments"), HULL.items())
def test_a_hull_is_wider_by_its_margin(client: Any, margin: float, moments: list[float]):
    body = p.createMultiBody(1, p.createCollisionShape(p.GEOM_MESH, vertices=CORNERS))
    assert inertia(body, margin) == pytest.approx(moments, abs=1e-8)


def test_the_margin_before_is_forgotten(client: Any):
    body = p.createMultiBody(1, p.createCollisionShape(p.GEOM_MESH, vertices=CORNERS))
    inertia(body, 0.01)
    assert inertia(body, 0.0) == pytest.approx(HULL[0.0], abs=1e-8)


@pytest.mark.parametrize(("margin", "moments"), OBJ.items())
def test_hulls_of_a_file_are_wider_by_their_margin(
    client: Any, tmp_path, margin: float, moments: list[float]
):
    (tmp_path / "cube.obj").write_text(CUBE)
    (tmp_path / "cube.urdf").write_text(ROBOT)
    body = p.loadURDF(str(tmp_path / "cube.urdf"))
    assert inertia(body, margin) == pytest.approx(moments, abs=1e-8)


@pytest.mark.parametrize(("margin", "distance"), [(None, 0.469), (0.001, 0.469), (0.02, 0.45)])
def test_points_nearest_to_a_shape_without_a_body_heed_the_margin_of_a_hull(
    client: Any, margin: float | None, distance: float
) -> None:
    hull = p.createCollisionShape(p.GEOM_MESH, vertices=CORNERS)
    body = p.createMultiBody(1.0, hull)
    if margin is not None:
        p.changeDynamics(body, -1, collisionMargin=margin)
    ball = p.createCollisionShape(p.GEOM_SPHERE, radius=0.23)
    (point,) = p.getClosestPoints(body, -1, 1.0, collisionShapeB=ball, collisionShapePositionB=[0, 0, 1])
    assert point[8] == pytest.approx(distance, abs=1e-9)
