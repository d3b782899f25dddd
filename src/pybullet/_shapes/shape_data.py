"""Queries about the shapes of bodies."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from carom.description.pose import Quaternion, Vector3
from carom.description.transform import quaternion_from_matrix
from pybullet._calls.arguments import integer
from pybullet._calls.builtin import exported
from pybullet._calls.constants import VISUAL_SHAPE_DATA_TEXTURE_UNIQUE_IDS
from pybullet._calls.errors import fail, no_body
from pybullet._clients.clients import Client, client_of, clients
from pybullet._clients.lookup import BASE, body_of, link_of

if TYPE_CHECKING:
    from carom.scene.body import Body

__all__ = ["getAABB", "getCollisionShapeData", "getMeshData", "getVisualShapeData"]

CollisionData = tuple[int, int, int, Vector3, bytes, Vector3, Quaternion]

_NO_COLLISION_DATA = "Error receiving collision shape info"
_NO_AABB = "getAABB failed."
_NO_MESH = "getMeshData failed"


@exported
def getCollisionShapeData(
    objectUniqueId: int, linkIndex: int, physicsClientId: int = 0
) -> tuple[CollisionData, ...]:
    """The collision shapes of a link.

    Args:
        objectUniqueId: The body.
        linkIndex: The link, from 0; -1 for the base.
        physicsClientId: The connection.

    Returns:
        For each shape 7 fields: 0 body; 1 link; 2 type, `GEOM_*`; 3 dimensions: edges of a box, length and
        radius of a capsule or cylinder, radius of a sphere three times, normal of a plane, scale of a
        mesh; 4 file of a mesh, as bytes; 5 position [m] and 6 orientation (x, y, z, w) in the inertial
        frame of the link. Meshes that `createCollisionShape` creates, and cylinders of a file, which are
        convex hulls, have the file `b"unknown_file"`. Heightfields are left out.

    Raises:
        pybullet.error: Not connected, or there is no such body or link.

    Examples:
        >>> shape = p.getCollisionShapeData(cube, -1)[0]
        >>> shape[2] == p.GEOM_BOX, shape[3]
        (True, (0.05, 0.05, 0.05))
    """
    client = client_of(physicsClientId)
    body, link = _body_and_link(client, objectUniqueId, linkIndex, _NO_COLLISION_DATA)

    from carom.layouts.flags import LoadFlags
    from carom.model.inertia import placement

    spec = body.link_spec(link)
    implicit = bool(body.spec.flags & LoadFlags.USE_IMPLICIT_CYLINDER)
    result = []
    for collision in spec.collisions:
        described = collision.geometry.collision_data(implicit_cylinder=implicit)
        if described is not None:
            kind, dimensions, file = described
            rotation, position = placement(spec.inertial_frame, collision.frame)
            orientation = quaternion_from_matrix(rotation)
            result.append((body.id, link, kind, dimensions, file, position, orientation))
    return tuple(result)


@exported
def getVisualShapeData(
    objectUniqueId: int, flags: int = 0, physicsClientId: int = 0
) -> tuple[tuple[Any, ...], ...]:
    """The visual shapes of a body, or the collision shapes of links that have none.

    Args:
        objectUniqueId: The body.
        flags: `VISUAL_SHAPE_DATA_TEXTURE_UNIQUE_IDS` for a ninth field.
        physicsClientId: The connection.

    Returns:
        For each shape 8 fields: 0 body; 1 link, -1 for the base; 2 type, `GEOM_*`; 3 dimensions: edges of
        a box, length and radius of a capsule or cylinder, radius of a sphere, scale of a mesh; 4 file of
        a mesh, as bytes; 5 position [m] and 6 orientation (x, y, z, w) in the link frame; 7 colour; and,
        if asked for, 8 the id of the texture, -1 for none. Empty when there is no such body.

    Raises:
        pybullet.error: Not connected.

    Examples:
        >>> look = p.getVisualShapeData(cube)[0]
        >>> look[2] == p.GEOM_MESH, look[4].decode().endswith("cube.obj")
        (True, True)
    """
    client = client_of(physicsClientId)
    number, bits = integer(objectUniqueId, "objectUniqueId"), integer(flags, "flags")
    body = client.world.bodies.get(number)
    if body is None:
        return ()

    from carom.render.appearance import appearance_of
    from carom.render.textures import NO_TEXTURE

    result: list[tuple[Any, ...]] = []
    with client.call_lock:
        appearance = appearance_of(client.world)
        appearance.number_textures(list(client.world.bodies.values()))
        for link in range(BASE, body.joint_count):
            for look in appearance.shapes(body, link):
                described = look.geometry.visual_data()
                if body.spec.soft is not None:
                    described = (*described[:2], str(body.spec.source or "").encode())
                frame = look.frame
                data = (body.id, link, *described, frame.position, frame.orientation, look.rgba)
                if bits & VISUAL_SHAPE_DATA_TEXTURE_UNIQUE_IDS:
                    data = (*data, max(look.texture, NO_TEXTURE))
                result.append(data)
    return tuple(result)


@exported
def getMeshData(
    bodyUniqueId: int,
    linkIndex: int = -1,
    collisionShapeIndex: int = -1,
    flags: int = -1,
    physicsClientId: int = 0,
) -> tuple[int, tuple[Vector3, ...]]:
    """The corners of the convex hulls a link collides with, or those of a soft body. Other shapes have none.

    Args:
        bodyUniqueId: The body.
        linkIndex: The link, from 0; -1 for the base.
        collisionShapeIndex: Index of the shape; -1 for all.
        flags: For a soft body: `MESH_DATA_SIMULATION_MESH` for its nodes; otherwise the corners of all
            triangles of its surface, three for each. Plus 8: the velocities of the nodes [m/s].
        physicsClientId: The connection.

    Returns:
        (number of corners, (x, y, z) of each [m] in the inertial frame of the link; for a soft body in the
        world frame).

    Raises:
        pybullet.error: Not connected, or there is no such body or link.

    Examples:
        >>> count, corners = p.getMeshData(arm, 3)
        >>> count == len(corners)
        True
    """
    client = client_of(physicsClientId)
    index, bits = integer(collisionShapeIndex, "collisionShapeIndex"), integer(flags, "flags")
    soft = client.body(bodyUniqueId)
    if soft is not None and soft.spec.soft is not None:
        from pybullet._shapes.mesh_data import soft_corners

        return soft_corners(soft, bits)
    body, link = _body_and_link(client, bodyUniqueId, linkIndex, _NO_MESH)

    from pybullet._shapes.mesh_data import hull_corners

    corners = hull_corners(body, link, index)
    return len(corners), corners


@exported
def getAABB(bodyUniqueId: int, linkIndex: int = -1, physicsClientId: int = 0) -> tuple[Vector3, Vector3]:
    """The bounding box (AABB, axis-aligned in the world frame) of a link's collision shapes.

    As in PyBullet it is the box around the rotated local box of the shapes, which is larger than necessary
    except for boxes and spheres, and it includes collision margins.

    Args:
        bodyUniqueId: The body.
        linkIndex: The link, from 0; -1 for the base.
        physicsClientId: The connection.

    Returns:
        (minimum corner, maximum corner) [m].

    Raises:
        pybullet.error: Not connected, or there is no such body or link.

    Examples:
        >>> lower, upper = p.getAABB(cube)
        >>> [round(x, 3) for x in lower], [round(x, 3) for x in upper]
        ([0.475, -0.025, 0.0], [0.525, 0.025, 0.05])
    """
    try:
        return clients[physicsClientId].bodies[bodyUniqueId].boxes[linkIndex].corners()
    except (KeyError, TypeError, ValueError):
        client = client_of(physicsClientId)
        if integer(bodyUniqueId, "bodyUniqueId") < 0:
            fail("getAABB failed; invalid bodyUniqueId", no_body(bodyUniqueId))
        if integer(linkIndex, "linkIndex") < BASE:
            fail("getAABB failed; invalid linkIndex", f"{linkIndex} is less than -1, the base.")
        body, link = _body_and_link(client, bodyUniqueId, linkIndex, _NO_AABB)
        return client.bodies[body.id].boxes[link].corners()


def _body_and_link(client: Client, body_id: Any, link_index: Any, problem: str) -> tuple[Body, int]:
    body = body_of(client, body_id, problem)
    return body, link_of(body, link_index, "linkIndex", problem)
