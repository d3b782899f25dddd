"""Collision shapes that scripts create."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

from carom import description
from carom.description.pose import IDENTITY, Pose
from carom.errors import DescriptionError
from pybullet._calls.arguments import Indices, Vector, Vectors, integer, real, text
from pybullet._calls.builtin import exported
from pybullet._calls.constants import GEOM_FORCE_CONCAVE_TRIMESH, GEOM_HEIGHTFIELD, GEOM_MESH
from pybullet._calls.errors import fail, logger
from pybullet._calls.optional_vectors import optional_pose
from pybullet._clients.clients import Client, client_of
from pybullet._clients.shape_registry import CollisionShape
from pybullet._shapes.heightfields import heightfield, heights_from_data, heights_from_file, replace_heights
from pybullet._shapes.shape_arguments import find_file, is_primitive, points, primitive, scale_of, triangles
from pybullet._shapes.shape_columns import ShapeColumns

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    import numpy as np
    from numpy.typing import NDArray

__all__ = ["createCollisionShape", "createCollisionShapeArray", "removeCollisionShape"]

_FAILED = "createCollisionShape failed."

# PyBullet's collision margin of triangle meshes that are part of a compound [m].
_MARGIN = 0.001


@exported
def createCollisionShape(
    shapeType: int,
    radius: float = 0.5,
    halfExtents: Vector | None = None,
    height: float = 1,
    fileName: str | None = None,
    meshScale: Vector | None = None,
    planeNormal: Vector | None = None,
    flags: int = 0,
    collisionFramePosition: Vector | None = None,
    collisionFrameOrientation: Vector | None = None,
    vertices: Vectors | None = None,
    indices: Indices | None = None,
    heightfieldTextureScaling: float = 1,
    heightfieldData: Vector | None = None,
    numHeightfieldRows: int = -1,
    numHeightfieldColumns: int = -1,
    replaceHeightfieldIndex: int = -1,
    physicsClientId: int = 0,
) -> int:
    """Makes a collision shape, for any number of bodies made by `createMultiBody`.

    Meshes collide as their convex hull, one hull for each group of an OBJ file; hulls of fine meshes are
    simplified to 128 vertices. With `GEOM_FORCE_CONCAVE_TRIMESH`, or with `indices`, the triangles
    themselves collide, which is meant for bodies that do not move.

    Args:
        shapeType: `GEOM_SPHERE`, `GEOM_BOX`, `GEOM_CAPSULE`, `GEOM_CYLINDER`, `GEOM_PLANE`, `GEOM_MESH` or
            `GEOM_HEIGHTFIELD`. Cylinders and capsules lie along z.
        radius: Of a sphere, capsule or cylinder [m].
        halfExtents: Half the size of a box along x, y and z [m]; boxes need it.
        height: Of a cylinder, or of the part of a capsule between its two hemispheres [m].
        fileName: OBJ, STL or DAE file of a mesh; text or image file of a heightfield.
        meshScale: Factor on a mesh along x, y and z; distance between the points of a heightfield along x
            and y, and factor on its heights.
        planeNormal: Outward normal of the half space; z if not given.
        flags: `GEOM_FORCE_CONCAVE_TRIMESH`. `GEOM_CONCAVE_INTERNAL_EDGE` has no effect.
        collisionFramePosition: Origin of the shape in the link frame [m]. A heightfield stays at the
            origin.
        collisionFrameOrientation: Orientation of the shape in the link frame (x, y, z, w).
        vertices: Points of a mesh, three numbers each, instead of a file.
        indices: Three vertices for each triangle, one after the other.
        heightfieldTextureScaling: Number of repetitions of the texture in a window.
        heightfieldData: `numHeightfieldRows` * `numHeightfieldColumns` heights, x fastest. The mean of the
            minimum and the maximum is at the origin.
        numHeightfieldRows: Points along x.
        numHeightfieldColumns: Points along y.
        replaceHeightfieldIndex: A heightfield of the same size, which gets these heights, as do all bodies
            made of it; its position does not change.
        physicsClientId: The connection.

    Returns:
        The id of the shape.

    Raises:
        pybullet.error: Not connected, an unknown type, a size that is missing, negative or not finite, a
            file that is missing or cannot be used, or a wrong number of heights.

    Examples:
        >>> shape = p.createCollisionShape(p.GEOM_BOX, halfExtents=[0.1, 0.2, 0.3])
        >>> box = p.createMultiBody(baseMass=1, baseCollisionShapeIndex=shape, basePosition=[0, 2, 1])
    """
    client = client_of(physicsClientId)
    kind, bits = integer(shapeType, "shapeType"), integer(flags, "flags")
    pose = optional_pose(collisionFramePosition, collisionFrameOrientation, _FAILED, "collisionFrame")
    is_framed = collisionFramePosition is not None or collisionFrameOrientation is not None
    name = None if fileName is None else text(fileName, "fileName")
    if is_primitive(kind):
        sizes = radius, height, halfExtents, planeNormal
        shape = _placed(primitive(kind, _FAILED, *sizes, length_name="height"), pose)
    elif kind == GEOM_MESH and vertices is not None:
        shape = _mesh_from_data(vertices, indices, scale_of(meshScale, _FAILED), pose)
    elif kind == GEOM_MESH and name is not None:
        shape = _mesh_from_file(client, name, meshScale, bits, pose, is_part=is_framed, problem=_FAILED)
    elif kind == GEOM_MESH:
        fail(_FAILED, "A mesh needs fileName or vertices.")
    elif kind == GEOM_HEIGHTFIELD:
        real(heightfieldTextureScaling, "heightfieldTextureScaling")
        heights = _heights(client, name, heightfieldData, numHeightfieldRows, numHeightfieldColumns)
        replaced = integer(replaceHeightfieldIndex, "replaceHeightfieldIndex")
        if replaced >= 0:
            replace_heights(client, replaced, heights, _FAILED)
            return replaced
        shape = _placed(heightfield(heights, scale_of(meshScale, _FAILED), _FAILED), IDENTITY)
        shape.lasts = True
    else:
        fail(_FAILED, f"There is no type of shape {kind}.")
    _check_pieces(shape, _FAILED)
    return client.shapes.collisions.add(shape)


@exported
def createCollisionShapeArray(
    shapeTypes: Sequence[int],
    radii: Vector | None = None,
    halfExtents: Vectors | None = None,
    lengths: Vector | None = None,
    fileNames: Iterable[str] | None = None,
    meshScales: Vectors | None = None,
    planeNormals: Vectors | None = None,
    flags: Indices | None = None,
    collisionFramePositions: Vectors | None = None,
    collisionFrameOrientations: Vectors | None = None,
    physicsClientId: int = 0,
) -> int:
    """Makes one collision shape of several parts.

    The lists have a value for each part, even if its type does not need it. Parts that cannot be made are
    left out, with a warning.

    Args:
        shapeTypes: `GEOM_*` of each part.
        radii: As `radius` of `createCollisionShape`.
        halfExtents: As `halfExtents`; 1 m if not given.
        lengths: As `height`.
        fileNames: As `fileName`.
        meshScales: As `meshScale`.
        planeNormals: As `planeNormal`.
        flags: As `flags`.
        collisionFramePositions: As `collisionFramePosition`.
        collisionFrameOrientations: As `collisionFrameOrientation`.
        physicsClientId: The connection.

    Returns:
        The id of the shape.

    Raises:
        pybullet.error: Not connected, an argument is not a sequence, or no part can be made.

    Examples:
        >>> shape = p.createCollisionShapeArray(
        ...     [p.GEOM_SPHERE, p.GEOM_SPHERE],
        ...     radii=[0.1, 0.2],
        ...     collisionFramePositions=[[0, 0, 0], [0, 0, 0.3]],
        ... )
        >>> snowman = p.createMultiBody(1, shape, basePosition=[0, 2, 1])
    """
    given = locals()
    client = client_of(physicsClientId)
    columns = ShapeColumns("createCollisionShapeArray", "collision", given)
    is_part = len(columns.kinds) > 1 or columns.is_framed

    def part(index: int, kind: int) -> CollisionShape:
        pose, problem = columns.frame(index), columns.problem
        if is_primitive(kind):
            return _placed(columns.primitive(index), pose)
        file = columns.files.item(index)
        if kind != GEOM_MESH or file is None:
            fail(problem, f"type {kind} is not supported here, or has no file name.")
        name, bits = text(file, "fileNames"), integer(columns.flags.item(index, 0), "flags")
        scale = columns.scales.item(index)
        shape = _mesh_from_file(client, name, scale, bits, pose, is_part=is_part, problem=problem)
        _check_pieces(shape, problem)
        return shape

    parts = columns.each(part)
    return client.shapes.collisions.add(
        CollisionShape(
            tuple(collision for shape in parts for collision in shape.collisions),
            tuple(visual for shape in parts for visual in shape.visuals),
            lasts=any(shape.lasts for shape in parts),
        )
    )


@exported
def removeCollisionShape(collisionShapeId: int, physicsClientId: int = 0) -> None:
    """Removes a collision shape. Nothing happens if it does not exist, or if a body was made of it.

    The next shape gets its id. As in PyBullet height fields, and triangle meshes of files
    (`GEOM_FORCE_CONCAVE_TRIMESH`) that are a shape by themselves, stay.

    Args:
        collisionShapeId: The shape.
        physicsClientId: The connection.

    Raises:
        pybullet.error: Not connected.

    Examples:
        >>> shape = p.createCollisionShape(p.GEOM_SPHERE, radius=0.1)
        >>> p.removeCollisionShape(shape)
    """
    client = client_of(physicsClientId)
    number = integer(collisionShapeId, "collisionShapeId")
    shape = client.shapes.collisions.get(number)
    if shape is None:
        logger.warning("removeCollisionShape: there is no shape %d.", number)
    elif shape.used:
        logger.warning("removeCollisionShape: shape %d stays, because a body has been made of it.", number)
    elif shape.lasts:
        logger.warning(
            "removeCollisionShape: shape %d stays, as height fields and meshes of files do.", number
        )
    else:
        client.shapes.collisions.remove(number)


def _placed(geometry: description.Geometry, pose: Pose) -> CollisionShape:
    return CollisionShape((description.Collision(geometry, pose),))


def _mesh_from_data(
    vertices: Any, indices: Any, scale: tuple[float, float, float], pose: Pose
) -> CollisionShape:
    positions = points(vertices, _FAILED, "vertices")
    if not len(positions):
        fail(_FAILED, "vertices is empty.")
    scaled = positions * scale
    corners = triangles(() if indices is None else indices, len(positions), _FAILED)
    if len(corners):
        return _placed(description.TriangleMesh(scaled, corners, _MARGIN, scale), pose)
    return _placed(description.ConvexHull(scaled, scale), pose)


def _mesh_from_file(
    client: Client, name: str, mesh_scale: Any, flags: int, pose: Pose, *, is_part: bool, problem: str
) -> CollisionShape:
    """The shape of a mesh file; `is_part`: PyBullet would make it part of a compound."""
    from carom.model.shape_pieces import mesh_geometries

    mesh = description.Mesh(
        find_file(client, name, problem),
        scale_of(mesh_scale, problem),
        concave=bool(flags & GEOM_FORCE_CONCAVE_TRIMESH),
        asked_for=name,
    )
    try:
        geometries = mesh_geometries(mesh)
    except DescriptionError as reason:
        fail(problem, str(reason))
    collisions = []
    for geometry in geometries:
        if is_part and isinstance(geometry, description.TriangleMesh):
            geometry = replace(geometry, margin=_MARGIN)
        collisions.append(description.Collision(geometry, pose))
    visual = description.Visual(replace(mesh, concave=False), pose, stands_in=True)
    return CollisionShape(tuple(collisions), (visual,), lasts=mesh.concave and not is_part)


def _heights(client: Client, name: str | None, data: Any, rows: Any, columns: Any) -> NDArray[np.float64]:
    row_count, column_count = integer(rows, "numHeightfieldRows"), integer(columns, "numHeightfieldColumns")
    if name is not None:
        return heights_from_file(find_file(client, name, _FAILED), _FAILED)
    if data is not None and row_count > 0 and column_count > 0:
        return heights_from_data(data, row_count, column_count, _FAILED)
    fail(_FAILED, "A heightfield needs fileName, or heightfieldData and its numbers of rows and columns.")


def _check_pieces(shape: CollisionShape, problem: str) -> None:
    """Prepare the shape for collision detection now, so that errors are raised here."""
    from carom.model.shape_pieces import shape_pieces

    for collision in shape.collisions:
        try:
            shape_pieces(collision.geometry, implicit_cylinder=True)
        except DescriptionError as reason:
            fail(problem, str(reason))
