"""The shapes of a world as flat arrays, kept between images."""

from __future__ import annotations

import functools
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from math import sqrt
from typing import TYPE_CHECKING, Any, NamedTuple, cast
from weakref import ref

import numpy as np
from numpy.typing import NDArray

from carom.description import Geometry
from carom.description.pose import IDENTITY, Pose, Vector3
from carom.description.transform import Matrix3, compose, inverse, rotation_matrix
from carom.formats.visuals.render_mesh import RenderMesh
from carom.layouts.images import Scene
from carom.model.body_spec import BASE
from carom.native.products import dots, product
from carom.native.tables import put_array
from carom.render.appearance import LAST_SHOWN_GROUP, Appearance, ShapeLook, SkinLook
from carom.render.meshes import shape_mesh
from carom.render.parallel import worker_count
from carom.render.pybullet_meshes import mesh_in_pybullet
from carom.render.sites import shown_sites
from carom.render.textures import NO_TEXTURE, Textures

if TYPE_CHECKING:
    from carom.render.skins import SkinSurface
    from carom.render.soft_surfaces import SoftSurface
    from carom.scene.core.soft_core import SoftCore
    from carom.scene.core.world_core import WorldCore

MAX_PART_TRIANGLES = 2048
"""Larger meshes are cut into parts, so that parts out of view are skipped and threads share the others."""

CHUNKS_PER_WORKER = 3
_SITE, _SKIN = -1, -2
LINK_SHIFT = 24
"""Labels hold the body id in the bits below this one, and the link + 1 from this one upwards."""


@dataclass(repr=False, eq=False, slots=True)
class Piece:
    """Part of a mesh with its own vertices, and its bounding sphere.

    Positions and normals are (3, n): NumPy goes along rows, which are longer this way.
    """

    positions: NDArray[np.float64]
    normals: NDArray[np.float64]
    uvs: NDArray[np.float32]
    triangles: NDArray[np.int32]
    centre: NDArray[np.float64]
    radius: float


@functools.lru_cache(maxsize=1024)
def pieces_of(mesh: RenderMesh) -> tuple[Piece, ...]:
    """A mesh cut into pieces of at most `MAX_PART_TRIANGLES` triangles."""
    return _cut(mesh)


def _cut(mesh: RenderMesh) -> tuple[Piece, ...]:
    if 0 < len(mesh.triangles) <= MAX_PART_TRIANGLES and _uses_all_vertices(mesh):
        return (_piece(mesh, slice(None), mesh.triangles),)
    pieces = []
    for first in range(0, len(mesh.triangles), MAX_PART_TRIANGLES):
        used, inverse_index = np.unique(
            mesh.triangles[first : first + MAX_PART_TRIANGLES], return_inverse=True
        )
        triangles = inverse_index.reshape(-1, 3).astype(np.int32)
        pieces.append(_piece(mesh, used, triangles))
    return tuple(pieces)


def used_vertices(mesh: RenderMesh, piece: int) -> NDArray[np.int64]:
    """Numbers of the vertices of a mesh that one of its pieces has, in the order of the piece."""
    if 0 < len(mesh.triangles) <= MAX_PART_TRIANGLES and _uses_all_vertices(mesh):
        return np.arange(len(mesh.positions))
    first = piece * MAX_PART_TRIANGLES
    return np.unique(mesh.triangles[first : first + MAX_PART_TRIANGLES]).astype(np.int64)


def _uses_all_vertices(mesh: RenderMesh) -> bool:
    uses = np.bincount(mesh.triangles.reshape(-1), minlength=len(mesh.positions))
    return bool(uses.all())


def _piece(mesh: RenderMesh, used: NDArray[np.integer] | slice, triangles: NDArray[np.int32]) -> Piece:
    positions, normals = (
        values[used].T.astype(np.float64, order="C") for values in (mesh.positions, mesh.normals)
    )
    centre = 0.5 * (positions.min(axis=1) + positions.max(axis=1))
    away = positions - centre[:, None]
    x, y, z = away * away
    return Piece(positions, normals, mesh.uvs[used], triangles, centre, sqrt((x + y + z).max()))


@dataclass(repr=False, eq=False, slots=True)
class _Columns:
    """Lists from which the arrays of a scene are concatenated.

    Positions, normals and centres are in the frames of the shapes, of which rotations and places are those in
    the inertial frames of the links, for each part.
    """

    positions: list[NDArray[Any]] = field(default_factory=list)
    normals: list[NDArray[Any]] = field(default_factory=list)
    uvs: list[NDArray[Any]] = field(default_factory=list)
    triangles: list[NDArray[Any]] = field(default_factory=list)
    vertex_counts: list[int] = field(default_factory=list)
    triangle_counts: list[int] = field(default_factory=list)
    centres: list[NDArray[Any]] = field(default_factory=list)
    radii: list[float] = field(default_factory=list)
    rotations: list[Matrix3] = field(default_factory=list)
    places: list[Vector3] = field(default_factory=list)
    links: list[int] = field(default_factory=list)
    labels: list[int] = field(default_factory=list)
    rgba: list[tuple[float, ...]] = field(default_factory=list)
    two_sided: list[bool] = field(default_factory=list)
    textures: list[int] = field(default_factory=list)
    shapes: list[tuple[int, int, int]] = field(default_factory=list)


class OwnPart(NamedTuple):
    """A part of a shape that has another size in each of many worlds.

    Attributes:
        place: The body, the link and the number of the visible shape.
        geometry: The shape whose triangles the part has.
        end: The end of a capsule that it is, -1 or 1; 0 for other parts.
        frame: Pose of the shape in the inertial frame of the link.
    """

    place: tuple[int, int, int]
    geometry: Geometry
    end: int
    frame: Pose


class SceneArrays:
    """The visible shapes of a world, in the inertial frames of their links.

    Round shapes are round, or with `as_pybullet` as PyBullet's images show them.

    Attributes:
        struct: The arrays, as the kernels take them.
        link_rows: Rows of `World.link_pose` of the links with visible shapes; then, for each of `own_parts`,
            of its link.
        own_parts: Parts of shapes that have other sizes in other worlds. They have matrices of their own.
        part_links: Index in `link_rows` of the link each part belongs to.
        part_centres: (parts, 3) centre of the bounding sphere of each part, in the inertial frame of its link
            [m].
        part_radii: (parts,) radius of that sphere [m].
        part_shapes: Of each part the body, the link and the number of the visible shape, -1 for a site,
            -2 for a skin.
        vertex_count: Number of vertices.
        triangle_count: Number of triangles.
        chunk_count: Number of chunks of parts, each of which one task projects.
    """

    def __init__(
        self,
        world: WorldCore,
        appearance: Appearance,
        as_pybullet: bool = False,
        *,
        with_skins: bool = True,
        own: frozenset[tuple[int, int, int]] = frozenset(),
    ) -> None:
        """Skins are those of the world, so images of many worlds are without.

        `own` are the visible shapes that have another size in each of many worlds, as `OwnPart.place`.
        """
        self.with_skins: bool = with_skins
        self.own: frozenset[tuple[int, int, int]] = own
        self.own_parts: list[OwnPart] = []
        own_rows: list[int] = []
        self._as_pybullet = as_pybullet
        self._bodies = [ref(body) for body in world.bodies.values()]
        self._texture_slots: dict[int, int] = {}
        columns = _Columns()
        rows: list[int] = []
        self._surfaces: list[SoftSurface | SkinSurface] = []
        for body in world.bodies.values():
            sites = shown_sites(body) if body.spec.sites else {}
            for link in range(BASE, body.joint_count):
                shapes = [
                    *(
                        (number, it)
                        for number, it in enumerate(appearance.shapes(body, link))
                        if it.group <= LAST_SHOWN_GROUP
                    ),
                    *((_SITE, it) for it in sites.get(link, ())),
                ]
                if shapes:
                    to_inertial = inverse(body.link_inertial_frame(link))
                    label = body.id + ((link - BASE) << LINK_SHIFT)
                    for number, shape in shapes:
                        first = len(columns.vertex_counts)
                        place, frame = (body.id, link, number), compose(to_inertial, shape.frame)
                        if place in own:
                            self._add_own(columns, shape, frame, label, place)
                        else:
                            self._add_shape(columns, shape, frame, label, len(rows))
                        parts = len(columns.vertex_counts) - first
                        columns.shapes += [(body.id, link, number)] * parts
                        if body.spec.soft is not None:
                            self._surfaces.append(_soft_surface(columns, cast("SoftCore", body), first))
                    rows.append(body.first_link + link - BASE)
                    own_rows += [rows[-1]] * (len(self.own_parts) - len(own_rows))
        for skin in appearance.skins if with_skins else ():
            self._add_skin(columns, rows, world, skin)
        columns.links = [len(rows) - 1 - slot if slot < 0 else slot for slot in columns.links]
        self.link_rows: np.ndarray = np.array([*rows, *own_rows], dtype=np.int64)
        self.vertex_count: int = sum(columns.vertex_counts)
        self.triangle_count: int = sum(columns.triangle_counts)
        self.part_links: np.ndarray = np.array(columns.links, dtype=np.int64)
        rotations = np.array(columns.rotations).reshape(-1, 3, 3)
        places = np.array(columns.places).reshape(-1, 3)
        centres = np.array(columns.centres).reshape(-1, 3, 1)
        self.part_centres: np.ndarray = product(rotations, centres)[:, :, 0] + places
        self.part_radii: np.ndarray = np.array(columns.radii)
        self.part_shapes: list[tuple[int, int, int]] = columns.shapes
        self.struct: Any
        self.chunk_count: int
        self.struct, self.chunk_count = _struct(columns, rotations, places, self.part_centres)
        self._changes = appearance.changes
        self._take_textures(appearance.textures)

    def shows(self, world: WorldCore, appearance: Appearance) -> bool:
        """Whether the arrays are up to date, apart from the textures."""
        return self._changes == appearance.changes and [body() for body in self._bodies] == list(
            world.bodies.values()
        )

    def follow_nodes(self) -> None:
        """Update the surfaces of soft bodies from their nodes, and skins from their bones."""
        for surface in self._surfaces:
            surface.write(self.struct.__dict__["memory"], self.part_centres, self.part_radii)

    def _add_shape(self, columns: _Columns, shape: ShapeLook, frame: Pose, label: int, slot: int) -> None:
        """Add a shape that has this pose in the inertial frame of the link."""
        mesh = mesh_in_pybullet(shape.geometry) if self._as_pybullet and not shape.is_mapped else None
        self._add_pieces(columns, pieces_of(mesh or shape.mesh), shape, frame, label, slot)

    def _add_own(
        self, columns: _Columns, shape: ShapeLook, frame: Pose, label: int, place: tuple[int, int, int]
    ) -> None:
        """Add a shape that has another size in each of many worlds, each part with a matrix of its own."""
        geometry, mesh = shape.geometry, shape.mesh
        if not shape.is_mapped and geometry.with_shaft() != geometry:
            # There are no triangles between its ends.
            geometry = geometry.with_shaft()
            mesh = shape_mesh(geometry)
        corners = geometry.ends_at(mesh.positions[:, 2])[mesh.triangles]
        ends = np.where((corners == corners[:, :1]).all(axis=1), corners[:, 0], 0)
        for end in np.unique(ends).tolist():
            triangles = np.ascontiguousarray(mesh.triangles[ends == end])
            for piece in _cut(RenderMesh(mesh.positions, mesh.normals, mesh.uvs, triangles)):
                self._add_pieces(columns, [piece], shape, frame, label, -1 - len(self.own_parts))
                self.own_parts.append(OwnPart(place, geometry, end, frame))

    def _add_pieces(
        self,
        columns: _Columns,
        pieces: Sequence[Piece],
        shape: ShapeLook,
        frame: Pose,
        label: int,
        slot: int,
    ) -> None:
        rotation = rotation_matrix(frame.orientation)
        for piece in pieces:
            columns.positions.append(piece.positions)
            columns.normals.append(piece.normals)
            columns.uvs.append(piece.uvs)
            columns.triangles.append(piece.triangles)
            columns.vertex_counts.append(len(piece.uvs))
            columns.triangle_counts.append(len(piece.triangles))
            columns.centres.append(piece.centre)
            columns.radii.append(piece.radius)
            columns.rotations.append(rotation)
            columns.places.append(frame.position)
            columns.links.append(slot)
            columns.labels.append(label)
            columns.rgba.append(shape.rgba)
            columns.two_sided.append(shape.two_sided)
            columns.textures.append(self._texture_slot(shape.texture))

    def _add_skin(self, columns: _Columns, rows: list[int], world: WorldCore, it: SkinLook) -> None:
        """Add a skin, carried by a link of its first bone."""
        from carom.render.skins import SkinSurface, carrier_of

        carrier = carrier_of(world, it.skin)
        if carrier is None or it.look.group > LAST_SHOWN_GROUP:
            return
        body, link = carrier
        first = len(columns.vertex_counts)
        self._add_shape(columns, it.look, IDENTITY, body.id + ((link - BASE) << LINK_SHIFT), len(rows))
        rows.append(body.first_link + link - BASE)
        counts = columns.vertex_counts
        columns.shapes += [(body.id, link, _SKIN)] * (len(counts) - first)
        starts = np.concatenate([[0], np.cumsum(counts[first:-1])]).astype(np.int64)
        vertices = np.concatenate([used_vertices(it.look.mesh, n) for n in range(len(counts) - first)])
        self._surfaces.append(
            SkinSurface(world, it.skin, body, link, sum(counts[:first]), first, vertices, starts)
        )

    def _texture_slot(self, number: int) -> int:
        if number == NO_TEXTURE:
            return NO_TEXTURE
        return self._texture_slots.setdefault(number, len(self._texture_slots))

    def slot_of(self, number: int) -> int:
        """Where a texture of the scene is in its arrays."""
        return NO_TEXTURE if number == NO_TEXTURE else self._texture_slots[number]

    def have_textures(self, numbers: set[int], textures: Textures) -> None:
        """Have these textures, too, although no part has them; `struct` then has new arrays."""
        if not numbers <= self._texture_slots.keys():
            for number in sorted(numbers):
                self._texture_slot(number)
            self._take_textures(textures)

    def update_textures(self, textures: Textures) -> bool:
        """Copy the textures if any has changed; true if so: `struct` then has new arrays."""
        if self._texture_changes == textures.changes:
            return False
        self._take_textures(textures)
        return True

    def _take_textures(self, textures: Textures) -> None:
        self._texture_changes = textures.changes
        images = [textures.image(number) for number in self._texture_slots]
        # Bodies loaded from the same file have textures of their own, but share one image in memory.
        distinct = {id(image): image for image in images}
        # The lower row comes first, as in texture coordinates.
        texels = [image[::-1].reshape(-1, 3) for image in distinct.values()]
        starts = dict(zip(distinct, _starts(list(map(len, texels))).tolist(), strict=False))
        put_array(self.struct, "texture_first", np.array([starts[id(image)] for image in images]))
        sizes = np.array([image.shape[1::-1] for image in images], dtype=np.int32).reshape(-1, 2)
        put_array(self.struct, "texture_size", sizes)
        put_array(self.struct, "texel", np.concatenate([np.zeros((0, 3), np.uint8), *texels]))


def stretch_parts(
    matrices: NDArray[np.float64],
    scene: SceneArrays,
    sizes: Mapping[tuple[int, int, int], NDArray[np.float64]],
) -> NDArray[np.float64]:
    """Let parts have other sizes in each of n worlds.

    Args:
        matrices: (n, links, 4, 4) poses of the links of the scene, of which those of `own_parts` change.
        scene: The scene.
        sizes: Lengths of the sides of these shapes in each world [m], (n, 3), by `OwnPart.place`.

    Returns:
        The greatest factor by which a part of each link grows, (n, links).
    """
    growth = np.ones(matrices.shape[:2])
    first = len(scene.link_rows) - len(scene.own_parts)
    for slot, part in enumerate(scene.own_parts, start=first):
        how = part.geometry.stretch(sizes[part.place], part.end)
        turn = np.array(rotation_matrix(part.frame.orientation))
        place = np.array(part.frame.position)
        along = np.zeros((len(matrices), 4, 4))
        along[:, :3, :3] = product(turn * how.factors[:, np.newaxis], turn.T)
        along[:, :3, 3] = place + how.shift[:, np.newaxis] * turn[:, 2] - dots(along[:, :3, :3], place)
        along[:, 3, 3] = 1.0
        matrices[:, slot] = product(matrices[:, slot], along)
        growth[:, slot] = how.factors.max(axis=1)
    return growth


def _soft_surface(columns: _Columns, body: SoftCore, first_part: int) -> SoftSurface:
    from carom.render.soft_surfaces import SoftSurface

    counts = columns.vertex_counts
    starts = np.concatenate([[0], np.cumsum(counts[first_part:-1])]).astype(np.int64)
    return SoftSurface(body, sum(counts[:first_part]), first_part, len(counts), starts)


def _struct(
    columns: _Columns,
    rotations: NDArray[np.float64],
    places: NDArray[np.float64],
    centres: NDArray[np.float64],
) -> tuple[Any, int]:
    struct = Scene()
    none = np.zeros((0, 3))
    counts = columns.vertex_counts
    # The columns of the rotation of each vertex, and x, y and z of what it turns.
    (a, b, c), shifts = (np.repeat(values.T, counts, axis=-1) for values in (rotations, places))
    for name, values, shift in (
        ("vertex_position", columns.positions, shifts),
        ("vertex_normal", columns.normals, None),
    ):
        x, y, z = np.concatenate([none.T, *values], axis=1)
        turned = a * x + b * y + c * z
        put_array(struct, name, (turned if shift is None else turned + shift).T)
    put_array(struct, "vertex_uv", np.concatenate([none[:, :2], *columns.uvs]))
    vertex_starts = _starts(counts)
    triangle_starts = _starts(columns.triangle_counts)
    corners = [triangles + start for triangles, start in zip(columns.triangles, vertex_starts, strict=False)]
    put_array(struct, "triangle_corners", np.concatenate([none.astype(np.int32), *corners]))
    put_array(struct, "triangle_part", np.repeat(np.arange(len(columns.links)), columns.triangle_counts))
    put_array(struct, "part_first_vertex", vertex_starts)
    put_array(struct, "part_first_triangle", triangle_starts)
    put_array(struct, "part_centre", centres)
    put_array(struct, "part_radius", np.array(columns.radii))
    put_array(struct, "part_link", np.array(columns.links))
    put_array(struct, "part_label", np.array(columns.labels))
    put_array(struct, "part_rgba", np.array(columns.rgba).reshape(-1, 4))
    put_array(struct, "part_two_sided", np.array(columns.two_sided))
    put_array(struct, "part_texture", np.array(columns.textures))
    chunks = _chunk_starts(columns.triangle_counts)
    put_array(struct, "chunk_first_part", chunks)
    return struct, len(chunks) - 1


def _chunk_starts(triangle_counts: list[int]) -> NDArray[np.int32]:
    """First part of each chunk, then the number of parts; all chunks have similar numbers of triangles."""
    size = max(sum(triangle_counts) / (CHUNKS_PER_WORKER * worker_count()), 1.0)
    starts, filled = [0], 0
    for part, count in enumerate(triangle_counts):
        if filled >= size:
            starts.append(part)
            filled = 0
        filled += count
    return np.array([*starts, len(triangle_counts)], dtype=np.int32)


def _starts(counts: list[int]) -> NDArray[np.int32]:
    return np.concatenate([[0], np.cumsum(counts)]).astype(np.int32)
