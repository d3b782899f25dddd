"""Visual shapes that scripts create."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from carom import description
from carom.errors import DescriptionError
from pybullet._calls.arguments import Indices, Vector, Vectors, integer, text
from pybullet._calls.builtin import exported
from pybullet._calls.constants import GEOM_MESH
from pybullet._calls.errors import error, fail, logger
from pybullet._calls.optional_vectors import optional_pose, optional_vector3, optional_vector4
from pybullet._clients.clients import Client, client_of
from pybullet._shapes.shape_arguments import find_file, is_primitive, points, primitive, scale_of, triangles
from pybullet._shapes.shape_columns import Column, ShapeColumns

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    import numpy as np
    from numpy.typing import NDArray

__all__ = ["createVisualShape", "createVisualShapeArray"]

_FAILED = "createVisualShape failed."

_WHITE = (1.0, 1.0, 1.0, 1.0)
_HIGHLIGHT = (1.0, 1.0, 1.0)


@exported
def createVisualShape(
    shapeType: int,
    radius: float = 0.5,
    halfExtents: Vector | None = None,
    length: float = 1,
    fileName: str | None = None,
    meshScale: Vector | None = None,
    planeNormal: Vector | None = None,
    flags: int = 0,
    rgbaColor: Vector | None = None,
    specularColor: Vector | None = None,
    visualFramePosition: Vector | None = None,
    visualFrameOrientation: Vector | None = None,
    vertices: Vectors | None = None,
    indices: Indices | None = None,
    normals: Vectors | None = None,
    uvs: Vectors | None = None,
    physicsClientId: int = 0,
) -> int:
    """Makes a visual shape, for bodies made by `createMultiBody`.

    Args:
        shapeType: `GEOM_SPHERE`, `GEOM_BOX`, `GEOM_CAPSULE`, `GEOM_CYLINDER`, `GEOM_PLANE` or `GEOM_MESH`.
            Cylinders and capsules lie along z.
        radius: Of a sphere, capsule or cylinder [m].
        halfExtents: Half the size of a box along x, y and z [m]; boxes need it.
        length: Of a cylinder, or of the part of a capsule between its two hemispheres [m].
        fileName: OBJ, STL or DAE file of a mesh. If it is missing or cannot be used, a warning is logged, and
            nothing is visible.
        meshScale: Factor on a mesh along x, y and z.
        planeNormal: Must have a length; planes are drawn across z whatever it is, as in PyBullet.
        flags: No effect.
        rgbaColor: Red, green, blue and opacity from 0 to 1; white if not given.
        specularColor: Red, green and blue of its highlights.
        visualFramePosition: Origin of the shape in the link frame [m].
        visualFrameOrientation: Orientation of the shape in the link frame (x, y, z, w).
        vertices: Points of a mesh, three numbers each, instead of a file; with `indices`.
        indices: Three vertices for each triangle, one after the other.
        normals: Normal of the surface at each vertex.
        uvs: Texture coordinates of each vertex, two numbers each.
        physicsClientId: The connection.

    Returns:
        The id of the shape; visual and collision shapes are numbered separately.

    Raises:
        pybullet.error: Not connected, an unknown type, or a size that is missing, negative or not finite.

    Examples:
        >>> look = p.createVisualShape(p.GEOM_SPHERE, radius=0.1, rgbaColor=[1, 0, 0, 1])
        >>> ball = p.createMultiBody(baseVisualShapeIndex=look, basePosition=[0, 2, 1])
    """
    client = client_of(physicsClientId)
    kind = integer(shapeType, "shapeType")
    integer(flags, "flags")
    pose = optional_pose(visualFramePosition, visualFrameOrientation, _FAILED, "visualFrame")
    material = description.Material(
        rgba=optional_vector4(rgbaColor, _FAILED, "rgbaColor") or _WHITE,
        specular=optional_vector3(specularColor, _FAILED, "specularColor") or _HIGHLIGHT,
    )
    if is_primitive(kind):
        sizes = radius, length, halfExtents, planeNormal
        geometry = _as_drawn(primitive(kind, _FAILED, *sizes, length_name="length"))
    elif kind == GEOM_MESH and vertices is not None and indices is not None:
        geometry = _mesh_from_data(vertices, indices, normals, uvs, scale_of(meshScale, _FAILED))
    elif kind == GEOM_MESH and fileName is not None:
        geometry = _mesh_from_file(client, text(fileName, "fileName"), meshScale, _FAILED)
    elif kind == GEOM_MESH:
        fail(_FAILED, "A mesh needs fileName, or vertices and indices.")
    else:
        fail(_FAILED, f"There is no type of visual shape {kind}.")
    return client.shapes.visuals.add((description.Visual(geometry, pose, material=material),))


@exported
def createVisualShapeArray(
    shapeTypes: Sequence[int],
    radii: Vector | None = None,
    halfExtents: Vectors | None = None,
    lengths: Vector | None = None,
    fileNames: Iterable[str] | None = None,
    meshScales: Vectors | None = None,
    planeNormals: Vectors | None = None,
    flags: Indices | None = None,
    rgbaColors: Vectors | None = None,
    visualFramePositions: Vectors | None = None,
    visualFrameOrientations: Vectors | None = None,
    physicsClientId: int = 0,
) -> int:
    """Makes one visual shape of several parts.

    The lists have a value for each part, even if its type does not need it. Parts that cannot be made are
    left out, with a warning.

    Args:
        shapeTypes: `GEOM_*` of each part.
        radii: As `radius` of `createVisualShape`.
        halfExtents: As `halfExtents`; 1 m if not given.
        lengths: As `length`.
        fileNames: As `fileName`.
        meshScales: As `meshScale`.
        planeNormals: As `planeNormal`.
        flags: No effect.
        rgbaColors: As `rgbaColor`.
        visualFramePositions: As `visualFramePosition`.
        visualFrameOrientations: As `visualFrameOrientation`.
        physicsClientId: The connection.

    Returns:
        The id of the shape.

    Raises:
        pybullet.error: Not connected, an argument is not a sequence, or no part can be made.

    Examples:
        >>> look = p.createVisualShapeArray(
        ...     [p.GEOM_SPHERE, p.GEOM_SPHERE],
        ...     radii=[0.1, 0.2],
        ...     visualFramePositions=[[0, 0, 0], [0, 0, 0.3]],
        ... )
    """
    given = locals()
    client = client_of(physicsClientId)
    columns = ShapeColumns("createVisualShapeArray", "visual", given)
    colours = Column(rgbaColors, "rgbaColors", "rgba color")

    def part(index: int, kind: int) -> description.Visual:
        pose, problem = columns.frame(index), columns.problem
        integer(columns.flags.item(index, 0), "flags")
        rgba = optional_vector4(colours.item(index), problem, "rgbaColors")
        material = None if rgba is None else description.Material(rgba=rgba)
        file = columns.files.item(index)
        if is_primitive(kind):
            geometry = _as_drawn(columns.primitive(index))
        elif kind == GEOM_MESH and file is not None:
            geometry = _mesh_from_file(client, text(file, "fileNames"), columns.scales.item(index), problem)
        else:
            fail(problem, f"type {kind} is not supported here, or has no file name.")
        return description.Visual(geometry, pose, material=material)

    parts = columns.each(part)
    return client.shapes.visuals.add(tuple(parts))


def _as_drawn(geometry: description.Geometry) -> description.Geometry:
    """A primitive as PyBullet draws it: planes lie flat, whatever normal is asked for."""
    from carom.description.geometry import FLOOR

    return FLOOR if geometry.is_unbounded else geometry


def _mesh_from_file(client: Client, name: str, mesh_scale: Any, problem: str) -> description.Geometry:
    """The mesh of a file. If the file cannot be used, an empty mesh, as in PyBullet, and a logged warning."""
    from carom.files.bounded import is_fresh
    from carom.meshes import read_mesh

    scale = scale_of(mesh_scale, problem)
    try:
        mesh = description.Mesh(find_file(client, name, problem), scale, asked_for=name)
        read_mesh(mesh.path)
        if is_fresh(mesh.path):
            # The file may be deleted before the mesh is drawn.
            from carom.formats.visuals.reader import read_mesh_visual

            read_mesh_visual(mesh.path)
    except (error, DescriptionError) as reason:
        logger.warning("%s", reason)

        import numpy as np

        return description.TriangleMesh(np.empty((0, 3)), np.empty((0, 3), dtype=np.int32))
    return mesh


def _mesh_from_data(
    vertices: Any, indices: Any, normals: Any, uvs: Any, scale: tuple[float, float, float]
) -> description.Geometry:
    positions = points(vertices, _FAILED, "vertices")
    corners = triangles(indices, len(positions), _FAILED)
    if not len(corners):
        fail(_FAILED, "There are no triangles.")
    return description.TriangleMesh(
        positions * scale,
        corners,
        scale=scale,
        normals=_per_vertex(normals, len(positions), "normals", 3),
        uvs=_per_vertex(uvs, len(positions), "uvs", 2),
    )


def _per_vertex(values: Any, count: int, name: str, columns: int) -> NDArray[np.float64] | None:
    if values is None:
        return None
    rows = points(values, _FAILED, name, columns)
    if not len(rows):
        return None
    if len(rows) != count:
        fail(_FAILED, f"{name} has {len(rows)} items for {count} vertices.")
    return rows
