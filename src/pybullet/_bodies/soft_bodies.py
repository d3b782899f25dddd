"""Functions for soft bodies only: anchors, tetrahedra, positions of nodes."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from pybullet._calls.arguments import Vector, Vectors, integer, vector3
from pybullet._calls.builtin import exported
from pybullet._calls.errors import fail, no_body
from pybullet._clients.clients import Client, client_of
from pybullet._clients.lookup import BASE, body_of

if TYPE_CHECKING:
    from carom.description.pose import Vector3
    from carom.scene.soft_body import SoftBody

__all__ = ["createSoftBodyAnchor", "getTetraMeshData", "resetMeshData"]

_WORLD = -1


@exported
def createSoftBodyAnchor(
    softBodyBodyUniqueId: int,
    nodeIndex: int,
    bodyUniqueId: int = -1,
    linkIndex: int = -1,
    bodyFramePosition: Vector | None = None,
    physicsClientId: int = 0,
) -> int:
    """Anchors a node of a soft body, at its present place, to the world or to a link.

    The link gets the reaction force.

    Args:
        softBodyBodyUniqueId: The soft body.
        nodeIndex: Its node, from 0; see `getMeshData` with `MESH_DATA_SIMULATION_MESH`.
        bodyUniqueId: The body that holds it; -1 for the world.
        linkIndex: Its link; -1 for the base.
        bodyFramePosition: No effect, as in PyBullet: the node is held at its present place.
        physicsClientId: The connection.

    Returns:
        The number of the anchor, for `removeConstraint`.

    Raises:
        pybullet.error: Not connected, the body is not soft, or there is no such node, body or link.

    Examples:
        >>> p.resetSimulation(p.RESET_USE_DEFORMABLE_WORLD)
        >>> cloth = p.loadSoftBody("cloth_z_up.obj", useMassSpring=1, springElasticStiffness=40)
        >>> anchor = p.createSoftBodyAnchor(cloth, 0)
        >>> p.getNumConstraints()
        1
    """
    problem = "createSoftBodyAnchor failed."
    node, number = integer(nodeIndex, "nodeIndex"), integer(bodyUniqueId, "bodyUniqueId")
    link = integer(linkIndex, "linkIndex")
    if bodyFramePosition is not None:
        vector3(bodyFramePosition, problem, "bodyFramePosition")
    client = client_of(physicsClientId)
    soft, holder = _soft_body(client, softBodyBodyUniqueId, problem), None
    if number != _WORLD:
        holder = client.world.bodies.get(number)
        if holder is None:
            fail(problem, no_body(number))
    try:
        with client.call_lock:
            # As in PyBullet, see `Client.maximal`.
            twice = client.deformable and number in client.maximal
            return soft.anchor(
                node,
                holder,
                BASE if holder is None else link,
                damped=False,
                late_force=0.5 if twice else 0.0,
            ).id
    except (IndexError, ValueError) as reason:
        fail(problem, f"{reason}.")


@exported
def getTetraMeshData(
    bodyUniqueId: int, flags: int = -1, physicsClientId: int = 0
) -> tuple[int, tuple[Vector3, ...]]:
    """The corners of the tetrahedra of a soft body, four for each.

    Args:
        bodyUniqueId: The body.
        flags: Without effect.
        physicsClientId: The connection.

    Returns:
        (number of corners, (x, y, z) of each in the world frame [m]).

    Raises:
        pybullet.error: Not connected, or the body is not soft.

    Examples:
        >>> try:
        ...     p.getTetraMeshData(cube)
        ... except p.error as problem:
        ...     print(problem)
        getTetraMeshData failed Body 2 is rigid.
    """
    integer(flags, "flags")
    soft = _soft_body(client_of(physicsClientId), bodyUniqueId, "getTetraMeshData failed")
    corners = soft.nodes[soft.tetrahedra.reshape(-1)]
    return len(corners), tuple(map(tuple, corners.tolist()))


@exported
def resetMeshData(bodyUniqueId: int, vertices: Vectors, physicsClientId: int = 0) -> None:
    """Sets the positions of a soft body's nodes; they keep their velocities.

    Args:
        bodyUniqueId: The body.
        vertices: (x, y, z) of each node in the world frame [m]; see `getMeshData` with
            `MESH_DATA_SIMULATION_MESH`.
        physicsClientId: The connection.

    Raises:
        pybullet.error: Not connected, the body is not soft, or `vertices` does not have three finite numbers
            for each node.

    Examples:
        >>> p.resetSimulation(p.RESET_USE_DEFORMABLE_WORLD)
        >>> cloth = p.loadSoftBody("cloth_z_up.obj", useMassSpring=1, springElasticStiffness=40)
        >>> count, nodes = p.getMeshData(cloth, flags=p.MESH_DATA_SIMULATION_MESH)
        >>> p.resetMeshData(cloth, [(x, y, z + 1) for x, y, z in nodes])
        >>> round(p.getBasePositionAndOrientation(cloth)[0][2], 9)
        1.0
    """
    problem = "resetMeshData failed"
    client = client_of(physicsClientId)
    soft = _soft_body(client, bodyUniqueId, problem)
    try:
        with client.call_lock:
            soft.set_nodes(vertices)  # type: ignore[arg-type]
    except ValueError as reason:
        fail(problem, f"{reason}.")


def _soft_body(client: Client, body_id: Any, problem: str) -> SoftBody:
    from carom.scene.soft_body import SoftBody

    body = body_of(client, body_id, problem)
    if not isinstance(body, SoftBody):
        fail(problem, f"Body {body.id} is rigid.")
    return body
