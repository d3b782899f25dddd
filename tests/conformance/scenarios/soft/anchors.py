"""Bodies that nodes of cloth are anchored to, in the deformable world."""

from __future__ import annotations

from typing import Any

import numpy as np

from ...scenario import scenario
from ...soft_meshes import mesh_file, square_text


def _cloth(p: Any, **options: Any) -> int:
    arguments = {
        **{"basePosition": [0.0, 0.0, 1.0], "useMassSpring": 1, "useBendingSprings": 1},
        **{"springDampingStiffness": 0.0},
    }
    with mesh_file("cloth.obj", square_text(5)) as path:
        return p.loadSoftBody(path, **(arguments | options))


def _nodes(p: Any, body: int) -> np.ndarray:
    return np.array(p.getMeshData(body, -1, flags=p.MESH_DATA_SIMULATION_MESH)[1])


@scenario(tolerance=0.005)
def ball_pulls_on_a_corner_of_cloth(p: Any) -> dict[str, Any]:
    """A ball of 0.1 kg, pulled by 1 N, with a corner of cloth anchored to it: speed and places."""
    p.resetSimulation(p.RESET_USE_DEFORMABLE_WORLD)
    p.setGravity(0.0, 0.0, 0.0)
    cloth = _cloth(p, scale=2.0, mass=1.0, springElasticStiffness=40.0)
    corner = _nodes(p, cloth)[-1]
    shape = p.createCollisionShape(p.GEOM_SPHERE, radius=0.01)
    ball = p.createMultiBody(0.1, shape, basePosition=corner.tolist())
    p.createSoftBodyAnchor(cloth, len(_nodes(p, cloth)) - 1, ball, -1)
    speeds, heights = [], []
    for _ in range(60):
        place = p.getBasePositionAndOrientation(ball)[0]
        p.applyExternalForce(ball, -1, [0.0, 0.0, 1.0], place, p.WORLD_FRAME)
        p.stepSimulation()
        speeds.append(p.getBaseVelocity(ball)[0][2])
        heights.append([p.getBasePositionAndOrientation(ball)[0][2] - 1.0, _nodes(p, cloth)[-1, 2] - 1.0])
    return {"speed": speeds, "start": speeds[:10], "height": heights, "way": heights[:10]}


@scenario(tolerance=0.02)
def box_hangs_on_falling_cloth(p: Any) -> dict[str, Any]:
    """A box on one corner of cloth that swings down from its opposite corner: where box and corner are."""
    p.resetSimulation(p.RESET_USE_DEFORMABLE_WORLD)
    p.setGravity(0.0, 0.0, -9.81)
    cloth = _cloth(p, mass=0.2, springElasticStiffness=100.0)
    p.createSoftBodyAnchor(cloth, 0, -1, -1)
    shape = p.createCollisionShape(p.GEOM_BOX, halfExtents=[0.05, 0.05, 0.05])
    box = p.createMultiBody(0.3, shape, basePosition=_nodes(p, cloth)[-1].tolist())
    p.createSoftBodyAnchor(cloth, len(_nodes(p, cloth)) - 1, box, -1)
    places = []
    for _ in range(8):
        for _ in range(10):
            p.stepSimulation()
        places.append([*p.getBasePositionAndOrientation(box)[0], *_nodes(p, cloth)[-1]])
    return {"place": places}


@scenario(tolerance=0.01)
def two_pushed_balls_with_maximal_coordinates(p: Any) -> dict[str, Any]:
    """Balls on two corners of damped cloth, whose speed a controller pushes to 1 m/s: speeds and places.

    Forces act twice on them, the second time after the corners have followed. Damping makes the cloth follow
    the corners, and the balls feel nothing of it.
    """
    p.resetSimulation(p.RESET_USE_DEFORMABLE_WORLD)
    p.setGravity(0.0, 0.0, 0.0)
    p.setTimeStep(1.0 / 500.0)
    cloth = _cloth(p, scale=2.0, mass=1.0, springElasticStiffness=40.0, springDampingStiffness=0.5)
    balls = []
    for corner in (0, 24):
        place = _nodes(p, cloth)[corner].tolist()
        balls.append(p.createMultiBody(0.1, -1, basePosition=place, useMaximalCoordinates=True))
        p.createSoftBodyAnchor(cloth, corner, balls[-1], -1)
    speeds, places = [], []
    for _ in range(30):
        for ball in balls:
            error = np.array([0.0, 0.0, 1.0]) - p.getBaseVelocity(ball)[0]
            force = np.clip(20.0 * error, -10.0, 10.0)
            p.applyExternalForce(ball, -1, force.tolist(), [0.0, 0.0, 0.0], p.LINK_FRAME)
        p.stepSimulation()
        speeds.append([p.getBaseVelocity(ball)[0][2] for ball in balls])
        places.append([p.getBasePositionAndOrientation(balls[0])[0][2], _nodes(p, cloth)[0, 2]])
    return {"speed": speeds, "start": speeds[:3], "place": places}
