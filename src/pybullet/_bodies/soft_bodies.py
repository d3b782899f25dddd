"""Functions that only concern soft bodies. There are none in Carom yet, so each refuses what it is given."""

from __future__ import annotations

from typing import Any, NoReturn

from pybullet._calls.arguments import Vector, Vectors, integer
from pybullet._calls.builtin import exported
from pybullet._calls.errors import fail
from pybullet._clients.clients import client_of
from pybullet._clients.lookup import body_of

__all__ = ["createSoftBodyAnchor", "getTetraMeshData", "resetMeshData"]


@exported
def createSoftBodyAnchor(
    softBodyBodyUniqueId: int,
    nodeIndex: int,
    bodyUniqueId: int = -1,
    linkIndex: int = -1,
    bodyFramePosition: Vector | None = None,
    physicsClientId: int = 0,
) -> int:
    """Ties a point of a soft body to a body. As for any rigid body in PyBullet, it fails.

    Args:
        softBodyBodyUniqueId: The soft body.
        nodeIndex: Its point.
        bodyUniqueId: The body; -1 for the world.
        linkIndex: Its link.
        bodyFramePosition: Where on it [m].
        physicsClientId: The connection.

    Raises:
        pybullet.error: Always: not connected, or the body is not soft.

    Examples:
        >>> try:
        ...     p.createSoftBodyAnchor(cube, 0)
        ... except p.error as problem:
        ...     print(problem)
        createSoftBodyAnchor failed. Body 2 is rigid; Carom has no soft bodies in this version.
    """
    for value, name in ((nodeIndex, "nodeIndex"), (bodyUniqueId, "bodyUniqueId"), (linkIndex, "linkIndex")):
        integer(value, name)
    _refuse(softBodyBodyUniqueId, "createSoftBodyAnchor failed.", physicsClientId)


@exported
def getTetraMeshData(bodyUniqueId: int, flags: int = -1, physicsClientId: int = 0) -> tuple[int, Any]:
    """The tetrahedra of a soft body. As for any rigid body in PyBullet, it fails; see `getMeshData`.

    Args:
        bodyUniqueId: The body.
        flags: `MESH_DATA_SIMULATION_MESH`.
        physicsClientId: The connection.

    Raises:
        pybullet.error: Always: not connected, or the body is not soft.

    Examples:
        >>> try:
        ...     p.getTetraMeshData(cube)
        ... except p.error as problem:
        ...     print(problem)
        getTetraMeshData failed Body 2 is rigid; Carom has no soft bodies in this version.
    """
    integer(flags, "flags")
    _refuse(bodyUniqueId, "getTetraMeshData failed", physicsClientId)


@exported
def resetMeshData(bodyUniqueId: int, vertices: Vectors, physicsClientId: int = 0) -> None:
    """Moves the points of a soft body. As for any rigid body in PyBullet, it fails.

    Args:
        bodyUniqueId: The body.
        vertices: Their positions [m].
        physicsClientId: The connection.

    Raises:
        pybullet.error: Always: not connected, or the body is not soft.

    Examples:
        >>> try:
        ...     p.resetMeshData(cube, [[0, 0, 0]])
        ... except p.error as problem:
        ...     print(problem)
        resetMeshData failed Body 2 is rigid; Carom has no soft bodies in this version.
    """
    _refuse(bodyUniqueId, "resetMeshData failed", physicsClientId)


def _refuse(body_id: Any, problem: str, physics_client_id: Any) -> NoReturn:
    body = body_of(client_of(physics_client_id), body_id, problem)
    fail(problem, f"Body {body.id} is rigid; Carom has no soft bodies in this version.")
