"""Surfaces of soft bodies in images: their vertices follow the nodes."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from carom.description import TriangleMesh
from carom.description.transform import rotation_matrix
from carom.formats.visuals.render_mesh import NO_TEXTURE_UV, RenderMesh, mesh_of

if TYPE_CHECKING:
    from carom.scene.core.soft_core import SoftCore


def node_normals(nodes: NDArray[np.float64], faces: NDArray[np.int32]) -> NDArray[np.float64]:
    """(n, 3) unit normals at the nodes: area-weighted means over the triangles around each node."""
    corners = nodes[faces]
    across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals = np.zeros_like(nodes)
    for corner in range(3):
        np.add.at(normals, faces[:, corner], across)
    return normals / np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), np.finfo(float).tiny)


def nodes_at_base(body: SoftCore) -> tuple[NDArray[np.float64], NDArray[np.int32]]:
    """The surface of a soft body in the inertial frame of its base: (v, 3) vertices and (t, 3) triangles."""
    world, first = body.world, body.first_position
    x, y, z, w = world.position[first + 3 : first + 7].tolist()
    vertices, triangles = body.surface
    turn = np.array(rotation_matrix((x, y, z, w)))
    return (vertices - world.position[first : first + 3]) @ turn, triangles


def surface_mesh(body: SoftCore) -> RenderMesh:
    """The present surface of a soft body, in the link frame of its base.

    With texture coordinates each triangle has vertices of its own, in the order of its visual shape.
    """
    vertices, triangles = nodes_at_base(body)
    normals = node_normals(vertices, triangles)
    places = vertices + np.asarray(body.spec.base.inertial_frame.position)
    visual = body.spec.base.visuals[0].geometry
    assert isinstance(visual, TriangleMesh)
    if visual.uvs is None:
        return mesh_of(places, normals, np.full((len(vertices), 2), NO_TEXTURE_UV), triangles)
    corners = triangles.reshape(-1)
    return mesh_of(places[corners], normals[corners], visual.uvs, visual.triangles)


@dataclass(repr=False, eq=False, slots=True)
class SoftSurface:
    """The surface of a soft body in the arrays of a scene, three vertices for each triangle.

    Attributes:
        body: The body.
        first_vertex: Row of its first vertex.
        first_part: Row of its first part.
        end_part: Row after its last part.
        part_starts: First vertex of each of these parts, relative to `first_vertex`.
    """

    body: SoftCore
    first_vertex: int
    first_part: int
    end_part: int
    part_starts: NDArray[np.int64]

    def write(self, arrays: dict[str, Any], centres: NDArray[np.float64], radii: NDArray[np.float64]) -> None:
        """Update the arrays of a scene, by their names in `Scene`, from the positions of the nodes.

        `centres` and `radii` [m] are of the parts' bounding spheres, in the inertial frames of their links.
        """
        nodes, triangles = nodes_at_base(self.body)
        corners = triangles.reshape(-1)
        rows = slice(self.first_vertex, self.first_vertex + len(corners))
        arrays["vertex_position"][rows] = nodes[corners]
        arrays["vertex_normal"][rows] = node_normals(nodes, triangles)[corners]
        parts = slice(self.first_part, self.end_part)
        lower = np.minimum.reduceat(nodes[corners], self.part_starts)
        upper = np.maximum.reduceat(nodes[corners], self.part_starts)
        centres[parts] = 0.5 * (lower + upper)
        radii[parts] = 0.5 * np.linalg.norm(upper - lower, axis=1)
        arrays["part_centre"][parts], arrays["part_radius"][parts] = centres[parts], radii[parts]
