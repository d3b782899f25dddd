"""Corners of convex hulls and of soft bodies, for `getMeshData`."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from carom.description import Collision, ConvexHull, Geometry, Mesh
from carom.description.pose import Pose, Vector3
from carom.layouts.flags import LoadFlags
from carom.model.inertia import is_in_place, placement
from carom.model.shape_pieces import grid_corners, mesh_geometries, shape_pieces
from carom.native.products import product
from carom.scene.body import Body
from carom.scene.soft_body import SoftBody
from pybullet._calls.constants import MESH_DATA_SIMULATION_MESH

Corners = NDArray[np.float64]


# Flag of `getMeshData` for the node velocities of soft bodies; PyBullet has no name for it.
_VELOCITIES = 8


def soft_corners(body: Body, flags: int) -> tuple[int, tuple[Vector3, ...]]:
    """The result of `getMeshData` for a soft body; negative flags count as 0."""
    assert isinstance(body, SoftBody)
    bits = max(flags, 0)
    values = body.node_velocities if bits & _VELOCITIES else body.nodes
    if not bits & (MESH_DATA_SIMULATION_MESH | _VELOCITIES):
        vertices, triangles = body.surface
        values = vertices[triangles.reshape(-1)]
    return len(values), tuple(map(tuple, values.tolist()))


def hull_corners(body: Body, link: int, index: int) -> tuple[Vector3, ...]:
    """Corners of a link's convex hulls in its inertial frame [m].

    `index` is that of the shape, if the link has several, and of the group in an OBJ file; negative for all.
    """
    spec = body.link_spec(link)
    implicit = bool(body.spec.flags & LoadFlags.USE_IMPLICIT_CYLINDER)
    if is_in_place(spec.collisions, spec.inertial_frame):
        chosen = list(spec.collisions)
    else:
        chosen = [it for place, it in enumerate(spec.collisions) if index < 0 or index == place]
    corners = [
        _placed(points, spec.inertial_frame, collision)
        for collision in chosen
        for points in _hulls(collision.geometry, index, implicit)
    ]
    rows = np.concatenate(corners) if corners else np.empty((0, 3))
    return tuple((x, y, z) for x, y, z in rows.tolist())


def _hulls(geometry: Geometry, index: int, implicit_cylinder: bool) -> Iterator[Corners]:
    match geometry:
        case ConvexHull():
            yield grid_corners(geometry)
        case Mesh(concave=False):
            groups = mesh_geometries(geometry)
            is_compound = geometry.path.suffix.lower() == ".obj"
            for place, group in enumerate(groups):
                if index < 0 or not is_compound or index == place:
                    yield from _hulls(group, index, implicit_cylinder)
        case _ if (
            geometry.core(implicit_cylinder=implicit_cylinder) is None and geometry.facets() is not None
        ):
            for piece in shape_pieces(geometry, implicit_cylinder=implicit_cylinder):
                if piece.polyhedron is not None:
                    yield piece.polyhedron.vertices


def _placed(points: Corners, inertial_frame: Pose, collision: Collision) -> Corners:
    rotation, position = placement(inertial_frame, collision.frame)
    return product(points, np.array(rotation).T) + position
