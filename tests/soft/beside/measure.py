"""Experiments with soft bodies of given parameters, each of which gives one figure; for either engine."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Any

import numpy as np
from tests.conformance.scenario import ASSETS
from tests.conformance.soft_meshes import cuboid_text, mesh_file, square_text

_GRAVITY = 10.0
# Nothing of these experiments gets this far from where it was [m]; what does has exploded.
_FAR = 5.0
# The last second tells where a body rests, and how much it still moves.
_LAST = 1.0
_SIZE = 0.4


@dataclass(frozen=True)
class Result:
    """What came of an experiment.

    Attributes:
        figure: Its figure [m or s]; None if the body exploded.
        unrest: How much the figure went up and down in the last second [m].
    """

    figure: float | None
    unrest: float


class ExplodedError(Exception):
    """A node is not finite, or where no node could be."""


def nodes_of(p: Any, body: int) -> np.ndarray:
    """Where the nodes of a body are [m]; raises ExplodedError if some are nowhere."""
    nodes = np.array(p.getMeshData(body, -1, flags=p.MESH_DATA_SIMULATION_MESH)[1])
    if not np.isfinite(nodes).all() or np.abs(nodes).max() > _FAR:
        raise ExplodedError
    return nodes


def _world(p: Any, rate: int) -> None:
    p.resetSimulation(p.RESET_USE_DEFORMABLE_WORLD)
    p.setGravity(0, 0, -_GRAVITY)
    p.setTimeStep(1.0 / rate)


def _hold(p: Any, body: int, nodes: Iterable[int]) -> None:
    for node in nodes:
        p.createSoftBodyAnchor(body, int(node), -1, -1)


def _rest(p: Any, body: int, rate: int, seconds: float, figure: Callable[[np.ndarray], float]) -> Result:
    """Mean of a figure over the last second.

    PyBullet puts soft bodies to sleep once they are slow, wherever they are; so it is kept from that.
    """
    p.changeDynamics(body, -1, activationState=p.ACTIVATION_STATE_DISABLE_SLEEPING)
    seen = []
    every = max(1, rate // 24)
    for step in range(round(rate * seconds)):
        p.stepSimulation()
        if step % every == 0:
            nodes = nodes_of(p, body)
            if step >= rate * (seconds - _LAST):
                seen.append(figure(nodes))
    return Result(float(np.mean(seen)), float(np.ptp(seen)))


def _cloth(p: Any, side: int, upright: bool, options: dict[str, Any]) -> int:
    turned = p.getQuaternionFromEuler([np.pi / 2 if upright else 0.0, 0, 0])
    with mesh_file("cloth.obj", square_text(side)) as path:
        return p.loadSoftBody(path, baseOrientation=turned, useMassSpring=1, collisionMargin=0.01, **options)


def cloth_by_an_edge(p: Any, rate: int = 240, side: int = 9, seconds: float = 6.0, **options: Any) -> Result:
    """A square of 1 m that hangs by its upper edge: how much longer it gets."""
    _world(p, rate)
    cloth = _cloth(p, side, True, options)
    start = nodes_of(p, cloth)
    _hold(p, cloth, np.flatnonzero(start[:, 2] > 0.499))
    lower = start[:, 2] < -0.499
    return _rest(p, cloth, rate, seconds, lambda nodes: -0.5 - float(nodes[lower, 2].mean()))


def cloth_by_two_corners(
    p: Any, rate: int = 240, side: int = 9, seconds: float = 10.0, **options: Any
) -> Result:
    """A square of 1 m that lies level and falls, but for two corners: how deep it hangs."""
    _world(p, rate)
    cloth = _cloth(p, side, False, options)
    _hold(p, cloth, (0, side - 1))
    return _rest(p, cloth, rate, seconds, lambda nodes: -float(nodes[:, 2].mean()))


def cloth_swings(p: Any, rate: int = 240, side: int = 9, **options: Any) -> Result:
    """A square of 1 m that hangs by its upper edge and is let go askew: the period of its swing [s]."""
    _world(p, rate)
    cloth = _cloth(p, side, True, options)
    start = nodes_of(p, cloth)
    _hold(p, cloth, np.flatnonzero(start[:, 2] > 0.499))
    # It is made to lie askew, for nodes cannot be given velocities.
    p.stepSimulation()
    places = nodes_of(p, cloth)
    places[:, 1] += 0.1 * (0.5 - places[:, 2])
    p.resetMeshData(cloth, places.tolist())
    crossings, last = [], 1.0
    for step in range(round(rate * 2.5)):
        p.stepSimulation()
        across = float(nodes_of(p, cloth)[:, 1].mean())
        if across * last < 0.0:
            crossings.append((step + last / (last - across)) / rate)
        last = across
    half = np.diff(crossings)[:2]
    if len(half) < 2:
        raise ExplodedError
    return Result(2.0 * float(half.mean()), float(np.ptp(half)))


def cantilever(
    p: Any,
    rate: int = 240,
    cells: tuple[int, int, int] = (4, 2, 2),
    seconds: float = 4.0,
    **options: Any,
) -> Result:
    """A short beam of tetrahedra that is held at one end: how far the other one hangs down."""
    _world(p, rate)
    with mesh_file("beam.vtk", cuboid_text(cells, (_SIZE, _SIZE / 2, _SIZE / 2))) as path:
        beam = p.loadSoftBody(path, collisionMargin=0.006, **options)
    start = nodes_of(p, beam)
    _hold(p, beam, np.flatnonzero(start[:, 0] < -0.199))
    end = start[:, 0] > 0.199
    return _rest(p, beam, rate, seconds, lambda nodes: -float(nodes[end, 2].mean()))


def dropped(
    p: Any,
    rate: int = 240,
    cells: int = 3,
    ball: bool = False,
    seconds: float = 4.0,
    **options: Any,
) -> Result:
    """A cube or a ball of tetrahedra that falls on a floor: how high its top is at rest."""
    _world(p, rate)
    p.loadURDF(str(ASSETS / "plane.urdf"))
    with mesh_file("solid.vtk", cuboid_text((cells, cells, cells), (_SIZE, _SIZE, _SIZE), ball=ball)) as path:
        arguments = {"frictionCoeff": 0.5, "useNeoHookean": 1, "collisionMargin": 0.006} | options
        solid = p.loadSoftBody(path, basePosition=[0, 0, 0.22], **arguments)
    return _rest(p, solid, rate, seconds, lambda nodes: float(nodes[:, 2].max()))


EXPERIMENTS: dict[str, Callable[..., Result]] = {
    experiment.__name__: experiment
    for experiment in (cloth_by_an_edge, cloth_by_two_corners, cloth_swings, cantilever, dropped)
}


def perform(p: Any, experiment: str, options: dict[str, Any]) -> Result:
    """Do an experiment in a world of its own."""
    client = p.connect(p.DIRECT)
    try:
        return EXPERIMENTS[experiment](p, **options)
    except ExplodedError:
        return Result(None, 0.0)
    finally:
        p.disconnect(client)
