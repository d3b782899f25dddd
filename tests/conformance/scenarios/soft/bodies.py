"""Cloth and soft solids in the deformable world.

Each scenario loads one soft body: what PyBullet was told of one also holds for others of the same process.
The engines do not integrate alike (PyBullet takes elastic forces once a step, at 1/240 s), so motion is
compared where it can be foreseen: at rest, in the first swing, and while sliding.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from ...scenario import ASSETS, Kind, scenario
from ...soft_meshes import cuboid_text, mesh_file, square_text

_GRAVITY = 10.0
_CORNERS, _SIDE = (0, 8), 9


_CUBE = cuboid_text((3, 3, 3), (0.4, 0.4, 0.4))


def _start(p: Any, gravity: tuple[float, float, float] = (0.0, 0.0, -_GRAVITY)) -> None:
    p.resetSimulation(p.RESET_USE_DEFORMABLE_WORLD)
    p.setGravity(*gravity)


def _cloth(p: Any, **options: Any) -> int:
    arguments = {"mass": 1.0, "useMassSpring": 1, "springElasticStiffness": 40.0, "collisionMargin": 0.01}
    with mesh_file("cloth.obj", square_text(_SIDE)) as path:
        return p.loadSoftBody(path, **(arguments | options))


def _solid(p: Any, mesh: str = _CUBE, /, **options: Any) -> int:
    arguments = {"mass": 4.0, "useNeoHookean": 1, "collisionMargin": 0.006}
    with mesh_file("cube.vtk", mesh) as path:
        return p.loadSoftBody(path, **(arguments | options))


def _nodes(p: Any, body: int) -> np.ndarray:
    return np.array(p.getMeshData(body, -1, flags=p.MESH_DATA_SIMULATION_MESH)[1])


def _after(p: Any, body: int, seconds: float) -> np.ndarray:
    for _ in range(round(240 * seconds)):
        p.stepSimulation()
    return _nodes(p, body)


@scenario(tolerance=0.01)
def soft_cube_hangs(p: Any) -> dict[str, Any]:
    """A cube of tetrahedra held by its upper face: where all its nodes come to rest."""
    _start(p)
    options = {"NeoHookeanMu": 400.0, "NeoHookeanLambda": 400.0, "NeoHookeanDamping": 0.1}
    cube = _solid(p, basePosition=[0, 0, 0], **options)
    for node in np.flatnonzero(_nodes(p, cube)[:, 2] > 0.199):
        p.createSoftBodyAnchor(cube, int(node), -1, -1)
    rest = _after(p, cube, 4.0)
    return {"nodes": rest, "lowest": [rest[:, 2].min() + 0.2]}


@scenario(tolerance=0.01)
def stiffer_soft_cube_hangs(p: Any) -> dict[str, Any]:
    """The same with other parameters, of which lambda is the larger."""
    _start(p)
    options = {"NeoHookeanMu": 300.0, "NeoHookeanLambda": 1500.0, "NeoHookeanDamping": 0.05}
    cube = _solid(p, basePosition=[0, 0, 0], **options)
    for node in np.flatnonzero(_nodes(p, cube)[:, 2] > 0.199):
        p.createSoftBodyAnchor(cube, int(node), -1, -1)
    rest = _after(p, cube, 4.0)
    return {"nodes": rest, "lowest": [rest[:, 2].min() + 0.2]}


@scenario(tolerance=0.02)
def soft_cube_rests_on_a_box(p: Any) -> dict[str, Any]:
    """A cube of tetrahedra dropped on a box: heights of its lower and upper face at rest."""
    _start(p)
    p.loadURDF(str(ASSETS / "plane.urdf"))
    options = {"NeoHookeanMu": 1500.0, "NeoHookeanLambda": 1500.0, "NeoHookeanDamping": 0.1}
    cube = _solid(p, basePosition=[0, 0, 0.22], frictionCoeff=0.5, **options)
    rest = _after(p, cube, 3.0)
    return {"height": [np.sort(rest[:, 2])[-16:].mean()], "extent": np.ptp(rest, axis=0)}


@scenario(tolerance=0.05)
def soft_cantilever_bends(p: Any) -> dict[str, Any]:
    """A short beam of tetrahedra held at one end: how far the other one hangs down."""
    _start(p)
    options = {"mass": 1.5, "NeoHookeanMu": 4000.0, "NeoHookeanLambda": 4000.0, "NeoHookeanDamping": 0.05}
    beam = _solid(p, cuboid_text((4, 2, 2), (0.4, 0.2, 0.2)), basePosition=[0, 0, 0], **options)
    start = _nodes(p, beam)
    for node in np.flatnonzero(start[:, 0] < -0.199):
        p.createSoftBodyAnchor(beam, int(node), -1, -1)
    end = start[:, 0] > 0.199
    return {"sag": [-_after(p, beam, 4.0)[end, 2].mean()]}


@scenario(tolerance=0.02)
def soft_ball_rests_on_a_box(p: Any) -> dict[str, Any]:
    """A ball of tetrahedra dropped on a box: how high it is at rest."""
    _start(p)
    p.loadURDF(str(ASSETS / "plane.urdf"))
    options = {"NeoHookeanMu": 2000.0, "NeoHookeanLambda": 2000.0, "NeoHookeanDamping": 0.1}
    mesh = cuboid_text((4, 4, 4), (0.4, 0.4, 0.4), ball=True)
    ball = _solid(p, mesh, basePosition=[0, 0, 0.22], frictionCoeff=0.5, **options)
    rest = _after(p, ball, 3.0)
    return {"height": [rest[:, 2].max(), rest[:, 2].mean()]}


@scenario(tolerance=0.03)
def cloth_swings(p: Any) -> dict[str, Any]:
    """Cloth that hangs from its upper edge and is pushed a little: after how long it swings back."""
    _start(p)
    turned = p.getQuaternionFromEuler([np.pi / 2, 0, 0])
    cloth = _cloth(p, baseOrientation=turned, springElasticStiffness=200.0, springDampingStiffness=0.0)
    for node in np.flatnonzero(_nodes(p, cloth)[:, 2] > 0.49):
        p.createSoftBodyAnchor(cloth, int(node), -1, -1)
    # It is made to lie askew, for nodes cannot be given velocities.
    p.stepSimulation()
    places = _nodes(p, cloth)
    places[:, 1] += 0.1 * (0.5 - places[:, 2])
    p.resetMeshData(cloth, places.tolist())
    crossings, last = [], 1.0
    for step in range(600):
        p.stepSimulation()
        across = float(_nodes(p, cloth)[:, 1].mean())
        if across * last < 0.0:
            crossings.append((step + last / (last - across)) / 240.0)
        last = across
    return {"period": [2.0 * float(np.diff(crossings)[:2].mean())]}


@scenario(tolerance=0.02)
def cloth_stretches_under_its_weight(p: Any) -> dict[str, Any]:
    """Cloth that hangs from its upper edge, damped in all directions: its nodes at rest."""
    _start(p)
    turned = p.getQuaternionFromEuler([np.pi / 2, 0, 0])
    options = {"springDampingStiffness": 0.5, "springDampingAllDirections": 1}
    cloth = _cloth(p, baseOrientation=turned, **options)
    for node in np.flatnonzero(_nodes(p, cloth)[:, 2] > 0.49):
        p.createSoftBodyAnchor(cloth, int(node), -1, -1)
    return {"heights": _after(p, cloth, 6.0)[:, 2]}


@scenario(tolerance=0.05)
def cloth_swings_down(p: Any) -> dict[str, Any]:
    """Cloth held by two corners, without damping: its way down and back until it begins to fold."""
    _start(p)
    cloth = _cloth(p, springDampingStiffness=0.0)
    for node in _CORNERS:
        p.createSoftBodyAnchor(cloth, node, -1, -1)
    return {"way": [_after(p, cloth, 0.1)[:, 2].mean() for _ in range(12)]}


@scenario(tolerance=0.02)
def cloth_hangs_by_two_corners(p: Any) -> dict[str, Any]:
    """The same damped in all directions, where it comes to rest.

    The way there is not compared: PyBullet's cloth is damped about four times as much as its parameter says.
    A single triangle is damped as it should be.
    """
    _start(p)
    cloth = _cloth(p, springDampingStiffness=0.2, springDampingAllDirections=1)
    for node in _CORNERS:
        p.createSoftBodyAnchor(cloth, node, -1, -1)
    return {"heights": _after(p, cloth, 10.0)[:, 2]}


@scenario(tolerance=0.005)
def a_falling_triangle_is_damped(p: Any) -> dict[str, Any]:
    """A triangle of hardly any stiffness, held by a corner, whose fall is damped in all directions."""
    _start(p, (0.0, 0.0, -1.0))
    options = {"springElasticStiffness": 1e-9, "springDampingStiffness": 1.0, "springDampingAllDirections": 1}
    with mesh_file("triangle.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n") as path:
        cloth = p.loadSoftBody(path, mass=3.0, useMassSpring=1, collisionMargin=0.001, **options)
    p.createSoftBodyAnchor(cloth, 0, -1, -1)
    return {"way": [_after(p, cloth, 0.5)[1, 2] for _ in range(4)]}


@scenario(tolerance=0.02)
def cloth_slides(p: Any) -> dict[str, Any]:
    """Cloth on a box under gravity that pulls sideways, with friction that is a product: how far it gets."""
    _start(p, (2.0, 0.0, -_GRAVITY))
    plane = p.loadURDF(str(ASSETS / "plane.urdf"))
    p.changeDynamics(plane, -1, lateralFriction=0.5)
    cloth = _cloth(p, basePosition=[0, 0, 0.0101], frictionCoeff=0.1, springDampingStiffness=0.1)
    return {"way": [_after(p, cloth, 0.1)[:, 0].mean() for _ in range(5)]}


@scenario(tolerance=0.02)
def box_rests_on_a_soft_cube(p: Any) -> dict[str, Any]:
    """A rigid box on a cube of tetrahedra: how far that is squeezed."""
    _start(p)
    p.loadURDF(str(ASSETS / "plane.urdf"))
    options = {"NeoHookeanMu": 4000.0, "NeoHookeanLambda": 4000.0, "NeoHookeanDamping": 0.1}
    _solid(p, basePosition=[0, 0, 0.207], frictionCoeff=0.5, **options)
    shape = p.createCollisionShape(p.GEOM_BOX, halfExtents=[0.3, 0.3, 0.1])
    box = p.createMultiBody(2.0, shape, basePosition=[0, 0, 0.52])
    for _ in range(720):
        p.stepSimulation()
    return {"height": [p.getBasePositionAndOrientation(box)[0][2]]}


@scenario(kind=Kind.INFO, tolerance={"center": 1e-6, "nodes": 1e-6})
def soft_body_getters(p: Any) -> dict[str, Any]:
    """What the getters say of cloth that has just been loaded."""
    _start(p)
    turned = p.getQuaternionFromEuler([0.1, 0.2, 0.3])
    cloth = _cloth(p, basePosition=[1, 2, 3], baseOrientation=turned, scale=2.0)
    visual = p.getVisualShapeData(cloth)[0]
    anchor = p.createSoftBodyAnchor(cloth, 0, -1, -1)
    return {
        "counts": [
            cloth,
            p.getNumBodies(),
            p.getNumJoints(cloth),
            p.getMeshData(cloth)[0],
            p.getMeshData(cloth, flags=p.MESH_DATA_SIMULATION_MESH)[0],
            p.getDynamicsInfo(cloth, -1)[10],
            visual[2],
            anchor,
            p.getNumConstraints(),
            p.getConstraintUniqueId(0),
        ],
        "names": [name.decode() for name in p.getBodyInfo(cloth)],
        "center": p.getBasePositionAndOrientation(cloth)[0],
        "nodes": _nodes(p, cloth),
    }
