"""`changeDynamics(collisionMargin=)`: what it changes, and of which shapes; numbers from PyBullet 3.2.7."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

import pybullet as p


@pytest.fixture(autouse=True)
def world():
    p.connect(p.DIRECT)
    yield
    p.disconnect()


@pytest.mark.parametrize("kind", [p.GEOM_SPHERE, p.GEOM_CAPSULE])
def test_the_margin_of_balls_and_capsules_is_their_radius(kind: int):
    body = p.createMultiBody(1, p.createCollisionShape(kind, radius=0.3, height=1))
    for margin in (0.0, 0.02, 0.5):
        p.changeDynamics(body, -1, collisionMargin=margin)
        assert p.getDynamicsInfo(body, -1)[11] == pytest.approx(0.3, abs=1e-8)


@pytest.mark.parametrize(("margin", "moments"), [(0.02, (0.0192, 0.0582)), (0.5, (0.48, 0.615))])
def test_the_margin_of_several_shapes_widens_the_box_that_they_count_as(
    margin: float, moments: tuple[float, float]
):
    shape = p.createCollisionShapeArray(
        shapeTypes=[p.GEOM_SPHERE, p.GEOM_BOX],
        radii=[0.1, 0.1],
        halfExtents=[[0.1] * 3] * 2,
        lengths=[0, 0],
        collisionFramePositions=[[0, 0, 0], [0.3, 0, 0]],
    )
    body = p.createMultiBody(1, shape)
    # The native library knows the moments without the margin from now on.
    p.changeDynamics(body, -1, mass=3)
    p.changeDynamics(body, -1, mass=4)
    p.changeDynamics(body, -1, collisionMargin=margin)
    p.changeDynamics(body, -1, mass=2)
    x, z = moments
    assert p.getDynamicsInfo(body, -1)[2] == pytest.approx((x, z, z), abs=1e-7)


def test_the_margin_of_a_ball_beside_the_centre_of_mass_counts():
    shape = p.createCollisionShape(p.GEOM_SPHERE, radius=0.3, collisionFramePosition=[0, 0, 0.1])
    body = p.createMultiBody(1, shape)
    p.changeDynamics(body, -1, collisionMargin=0.02)
    p.changeDynamics(body, -1, mass=2)
    assert p.getDynamicsInfo(body, -1)[11] == 0.02
    assert p.getDynamicsInfo(body, -1)[2] == pytest.approx((0.136533333,) * 3, abs=1e-8)


CORNERS = [[x, y, z] for x in (-0.1, 0.1) for y in (-0.1, 0.1) for z in (-0.1, 0.1)]
BESIDE = {"collisionFramePosition": [0.05, 0, 0]}


@pytest.mark.parametrize(
    ("shape", "margin", "lowest", "contact", "height"),
    [
        ({"shapeType": p.GEOM_MESH, "vertices": CORNERS}, 0.03, 0.019, (13, 0.00421), 0.12999),
        ({"shapeType": p.GEOM_MESH, "vertices": CORNERS}, 0.0, 0.049, (23, 0.00217), 0.09999),
        ({"shapeType": p.GEOM_MESH, "vertices": CORNERS, **BESIDE}, 0.03, 0.018, (13, 0.00421), 0.12999),
        ({"shapeType": p.GEOM_MESH, "vertices": CORNERS, **BESIDE}, 0.0, 0.048, (23, 0.00217), 0.09999),
        (
            {"shapeType": p.GEOM_CYLINDER, "radius": 0.1, "height": 0.2, **BESIDE},
            0.03,
            0.02,
            (23, 0.00217),
            0.09999,
        ),
        ({"shapeType": p.GEOM_BOX, "halfExtents": [0.1] * 3, **BESIDE}, 0.03, 0.02, (23, 0.00217), 0.09999),
        ({"shapeType": p.GEOM_BOX, "halfExtents": [0.1] * 3}, 0.03, 0.05, (23, 0.00217), 0.09999),
    ],
)
def test_a_margin_widens_hulls_and_the_bounds_of_compounds(
    shape: dict[str, Any], margin: float, lowest: float, contact: tuple[int, float], height: float
):
    p.setGravity(0, 0, -10)
    p.createMultiBody(0, p.createCollisionShape(p.GEOM_PLANE))
    body = p.createMultiBody(1, p.createCollisionShape(**shape), basePosition=[0, 0, 0.15])
    p.changeDynamics(body, -1, collisionMargin=margin)
    assert p.getAABB(body)[0][2] == pytest.approx(lowest, abs=1e-6)
    touched = []
    for step in range(240):
        p.stepSimulation()
        touched += [(step, point[8]) for point in p.getContactPoints()][:1]
    assert touched[0] == (contact[0], pytest.approx(contact[1], abs=1e-5))
    assert p.getBasePositionAndOrientation(body)[0][2] == pytest.approx(height, abs=2e-5)


@pytest.mark.parametrize(
    ("geom", "margin", "widened"),
    [
        ('type="box" size="0.1 0.2 0.3"', 0.010000000298023226, 0.7),
        ('type="box" size="1 2 3"', 0.04, -2.0),
        ('type="box" size="0.001 0.2 0.3"', 0.00010000000623986132, 0.7),
        ('type="box" size="0.1 0.2 0.3" pos="0 0 0.1"', 0.0, 0.78),
        ('type="cylinder" size="0.3 0.2"', 0.020000000596046452, 0.8),
        ('type="cylinder" size="0.1" fromto="0 0 -0.3 0 0 0.3"', 0.0, 0.68),
        ('type="capsule" size="0.1" fromto="0 0 -0.3 0 0 0.3"', 0.04, 0.58),
    ],
)
def test_margins_of_shapes_from_mjcf_files(tmp_path: Path, geom: str, margin: float, widened: float):
    file = tmp_path / "body.xml"
    file.write_text(
        '<mujoco><worldbody><body name="a" pos="0 0 1"><joint type="free"/>'
        f"<geom {geom}/></body></worldbody></mujoco>"
    )
    (body,) = p.loadMJCF(str(file))
    assert p.getDynamicsInfo(body, -1)[11] == pytest.approx(margin, rel=1e-12)
    p.changeDynamics(body, -1, collisionMargin=0.02)
    assert p.getDynamicsInfo(body, -1)[11] == 0.02
    assert p.getAABB(body)[0][2] == pytest.approx(widened, abs=1e-6)
