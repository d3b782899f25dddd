"""Faces of soft bodies in the deformable world: what meets cloth between its nodes.

The cloth is coarse: 2 m wide, with a node every 50 cm. Its damping is such that both engines agree on it.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from ...scenario import ASSETS, scenario
from ...soft_meshes import mesh_file, square_text

_GRAVITY = 9.81
_ROD = {"radius": 0.01, "height": 3.0}


def _start(p: Any, gravity: tuple[float, float, float] = (0.0, 0.0, -_GRAVITY)) -> None:
    p.resetSimulation(p.RESET_USE_DEFORMABLE_WORLD)
    p.setGravity(*gravity)


def _floor(p: Any) -> None:
    p.loadURDF(str(ASSETS / "plane.urdf"))


def _fixed(p: Any, kind: int, position: list[float], turn: float = 0.0, **shape: Any) -> int:
    orientation = p.getQuaternionFromEuler([0.0, turn, 0.0])
    shape_id = p.createCollisionShape(kind, **shape)
    return p.createMultiBody(0.0, shape_id, basePosition=position, baseOrientation=orientation)


def _cloth(p: Any, height: float, **options: Any) -> int:
    arguments = {
        **{"basePosition": [0.0, 0.0, height], "scale": 2.0, "mass": 1.0, "frictionCoeff": 0.5},
        **{"useMassSpring": 1, "useBendingSprings": 1, "springElasticStiffness": 40.0},
        **{"springDampingStiffness": 0.1, "springDampingAllDirections": 1},
    }
    with mesh_file("cloth.obj", square_text(5)) as path:
        return p.loadSoftBody(path, **(arguments | options))


def _nodes(p: Any, body: int) -> np.ndarray:
    return np.array(p.getMeshData(body, -1, flags=p.MESH_DATA_SIMULATION_MESH)[1])


def _after(p: Any, body: int, steps: int) -> np.ndarray:
    for _ in range(steps):
        p.stepSimulation()
    return _nodes(p, body)


@scenario(tolerance=0.05)
def coarse_cloth_falls_on_a_box(p: Any) -> dict[str, Any]:
    """Coarse cloth dropped on a box below one node: mean height of all nodes and of the nine inner ones."""
    _start(p)
    _floor(p)
    _fixed(p, p.GEOM_BOX, [0.0, 0.0, 0.5], halfExtents=[0.3, 0.3, 0.5])
    cloth = _cloth(p, 2.0)
    inner = np.abs(_nodes(p, cloth)[:, :2]).max(axis=1) < 0.6
    heights = [_after(p, cloth, 60)[:, 2] for _ in range(8)]
    return {"mean": [z.mean() for z in heights], "inner": [z[inner].mean() for z in heights]}


@scenario(tolerance=0.02)
def coarse_cloth_hangs_over_rods(p: Any) -> dict[str, Any]:
    """Coarse cloth on two rods, 2 cm thick, that lie between its rows of nodes: mean and greatest height."""
    _start(p)
    _floor(p)
    for y in (0.2, -0.3):
        _fixed(p, p.GEOM_CAPSULE, [0.0, y, 1.0], np.pi / 2, **_ROD)
    cloth = _cloth(p, 1.3)
    heights = [_after(p, cloth, 80)[:, 2] for _ in range(6)]
    return {"mean": [z.mean() for z in heights], "most": [z.max() for z in heights]}


@scenario(tolerance=0.05)
def coarse_cloth_hangs_on_a_pole(p: Any) -> dict[str, Any]:
    """Coarse cloth on a pole 1 cm thick in the middle of a face: mean and greatest height."""
    _start(p)
    _floor(p)
    _fixed(p, p.GEOM_BOX, [0.2, 0.13, 0.5], halfExtents=[0.005, 0.005, 0.5])
    cloth = _cloth(p, 1.3)
    places = [_after(p, cloth, 30) for _ in range(8)]
    return {"mean": [x[:, 2].mean() for x in places], "most": [x[:, 2].max() for x in places]}


@scenario(tolerance=0.05)
def coarse_cloth_hangs_on_a_ball(p: Any) -> dict[str, Any]:
    """Coarse cloth on a ball below the middle of a face: mean and greatest height."""
    _start(p)
    _floor(p)
    _fixed(p, p.GEOM_SPHERE, [0.2, 0.13, 0.8], radius=0.2)
    cloth = _cloth(p, 1.3)
    heights = [_after(p, cloth, 60)[:, 2] for _ in range(8)]
    return {"mean": [z.mean() for z in heights], "most": [z.max() for z in heights]}


@scenario(tolerance=0.05)
def box_falls_on_coarse_cloth(p: Any) -> dict[str, Any]:
    """A box of 0.5 kg on coarse cloth held by its corners, off all nodes: how it falls and rebounds."""
    _start(p)
    cloth = _cloth(p, 1.0, springElasticStiffness=400.0, springDampingStiffness=0.0)
    for node in np.flatnonzero(np.abs(_nodes(p, cloth)[:, :2]).min(axis=1) > 0.99):
        p.createSoftBodyAnchor(cloth, int(node), -1, -1)
    shape = p.createCollisionShape(p.GEOM_BOX, halfExtents=[0.08, 0.08, 0.08])
    box = p.createMultiBody(0.5, shape, basePosition=[0.22, 0.2, 1.2])
    heights = []
    for _ in range(12):
        _after(p, cloth, 20)
        heights.append(p.getBasePositionAndOrientation(box)[0][2])
    return {"height": heights}


@scenario(tolerance=0.05)
def coarse_cloth_slides_on_rails(p: Any) -> dict[str, Any]:
    """Coarse cloth on two rails between its nodes, pulled sideways: its way without and with friction."""
    ways = []
    for friction in (0.0, 1.0):
        _start(p, (3.0, 0.0, -_GRAVITY))
        for y in (-0.25, 0.25):
            _fixed(p, p.GEOM_BOX, [0.0, y, 0.5], halfExtents=[2.0, 0.05, 0.5])
        cloth = _cloth(p, 1.03, frictionCoeff=friction)
        ways.append([_after(p, cloth, 20)[:, 0].mean() for _ in range(8)])
    return {"way": np.array(ways).T}
