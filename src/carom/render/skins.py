"""Skins: surfaces whose vertices follow several links, or nodes of soft bodies."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from carom.description.pose import Pose
from carom.description.skin import NO_NODE, Bone, Skin
from carom.description.transform import compose, inverse, rotation_matrix
from carom.formats.visuals.render_mesh import NO_TEXTURE_UV, RenderMesh, mesh_of
from carom.model.body_spec import BASE
from carom.render.soft_surfaces import node_normals

if TYPE_CHECKING:
    from carom.scene.core.body_core import BodyCore
    from carom.scene.core.world_core import WorldCore

Floats = NDArray[np.float64]


def skin_at_rest(skin: Skin) -> RenderMesh:
    """The surface of a skin where its bones are at rest."""
    return _mesh(skin, skin.vertices, node_normals(skin.vertices, skin.triangles))


def carrier_of(world: WorldCore, skin: Skin) -> tuple[BodyCore, int] | None:
    """The link that carries a skin in images: that of its first bone which is on a body.

    None if a body with a bone has gone, or none has one.
    """
    if any(bone.place.body >= 0 and bone.place.body not in world.bodies for bone in skin.bones):
        return None
    for bone in skin.bones:
        if bone.place.body >= 0:
            return world.bodies[bone.place.body], bone.place.link
    return None


def skin_in(world: WorldCore, skin: Skin, frame: Pose) -> tuple[Floats, Floats]:
    """(n, 3) present vertices and normals of a skin in a frame that has a pose in the world."""
    vertices = np.zeros(skin.vertices.shape)
    for bone in skin.bones:
        turn, place = _bone(world, bone)
        np.add.at(vertices, bone.vertices, bone.weights[:, None] * (bone.points @ turn.T + place))
    turn = np.array(rotation_matrix(frame.orientation))
    vertices = (vertices - np.array(frame.position)) @ turn
    normals = node_normals(vertices, skin.triangles)
    return vertices + skin.inflation * normals if skin.inflation else vertices, normals


def skin_mesh(world: WorldCore, skin: Skin, body: BodyCore, link: int) -> RenderMesh:
    """The present surface of a skin in the frame of a link."""
    frame = compose(_pose(world, body, link), inverse(body.link_inertial_frame(link)))
    return _mesh(skin, *skin_in(world, skin, frame))


def _mesh(skin: Skin, vertices: Floats, normals: Floats) -> RenderMesh:
    uvs = np.full((len(vertices), 2), NO_TEXTURE_UV) if skin.uvs is None else skin.uvs
    return mesh_of(vertices, normals, uvs, skin.triangles)


def _bone(world: WorldCore, bone: Bone) -> tuple[Floats, Floats]:
    """Rotation and place of a bone in the world."""
    if bone.place.body < 0:
        pose = bone.frame
    elif bone.node != NO_NODE:
        first = world.bodies[bone.place.body].rows.first["node"]
        place = world.arrays.state.numpy["node_position"][0, first + bone.node]
        return np.array(rotation_matrix(bone.frame.orientation)), np.array(place)
    else:
        body, link = world.bodies[bone.place.body], bone.place.link
        pose = compose(_pose(world, body, link), compose(inverse(body.link_inertial_frame(link)), bone.frame))
    return np.array(rotation_matrix(pose.orientation)), np.array(pose.position)


def _pose(world: WorldCore, body: BodyCore, link: int) -> Pose:
    """Pose of the inertial frame of a link."""
    x, y, z, i, j, k, w = world.link_pose[body.first_link + link - BASE].tolist()
    return Pose((x, y, z), (i, j, k, w))


@dataclass(repr=False, eq=False, slots=True)
class SkinSurface:
    """A skin in the arrays of a scene, whose parts have their vertices one after the other.

    Attributes:
        world: The world.
        skin: The skin.
        body: The body that carries it.
        link: The link that carries it.
        first_vertex: Row of its first vertex.
        first_part: Row of its first part.
        vertices: Of each row of vertices the number in the skin.
        part_starts: First vertex of each part, relative to `first_vertex`.
    """

    world: WorldCore
    skin: Skin
    body: BodyCore
    link: int
    first_vertex: int
    first_part: int
    vertices: NDArray[np.int64]
    part_starts: NDArray[np.int64]

    def write(self, arrays: dict[str, Any], centres: Floats, radii: Floats) -> None:
        """Update the arrays of a scene, as `SoftSurface.write`."""
        places, normals = skin_in(self.world, self.skin, _pose(self.world, self.body, self.link))
        found = places[self.vertices]
        rows = slice(self.first_vertex, self.first_vertex + len(found))
        arrays["vertex_position"][rows] = found
        arrays["vertex_normal"][rows] = normals[self.vertices]
        parts = slice(self.first_part, self.first_part + len(self.part_starts))
        lower = np.minimum.reduceat(found, self.part_starts)
        upper = np.maximum.reduceat(found, self.part_starts)
        centres[parts] = 0.5 * (lower + upper)
        radii[parts] = 0.5 * np.linalg.norm(upper - lower, axis=1)
        arrays["part_centre"][parts], arrays["part_radius"][parts] = centres[parts], radii[parts]
