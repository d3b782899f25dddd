"""`changeDynamics(collisionMargin=)`: what it changes, and of which shapes; numbers from PyBullet 3.2.7."""

from __future__ import annotations

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
