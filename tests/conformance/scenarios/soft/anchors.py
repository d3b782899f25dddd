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
