"""Textures that are laid on shapes by rules: their images, and the texture coordinates of the triangles."""

from __future__ import annotations

import functools

import numpy as np
from numpy.typing import NDArray

from carom.description import Geometry
from carom.description.shapes.shape import TextureRule
from carom.description.texture import Texture
from carom.errors import DescriptionError
from carom.formats.visuals.render_mesh import NO_TEXTURE_UV, RenderMesh
from carom.logger import Logger
from carom.render.images import Texels, read_image

_log = Logger("carom")

_SIDES = "RLUDFB"
# Per side of a cube: the axis of its normal, and axis and sign of what is to the right and down on it.
_AXES = (
    (2, -1.0, 1, -1.0),
    (2, 1.0, 1, -1.0),
    (0, 1.0, 2, 1.0),
    (0, 1.0, 2, -1.0),
    (0, 1.0, 1, -1.0),
    (0, -1.0, 1, -1.0),
)
# Coordinates stay so far inside a side, in shares of it, that its neighbours are not mixed in.
_EDGE = 0.004
# Normals of the planes in which sides of a cube meet.
_BORDERS = ((1, 1, 0), (1, -1, 0), (0, 1, 1), (0, 1, -1), (1, 0, 1), (1, 0, -1))
_RAYS = slice(6, 9)
_ON_PLANE = 1e-9


@functools.lru_cache(maxsize=256)
def texture_image(texture: Texture) -> Texels | None:
    """The image of a texture; if a file of it cannot be read, a warning is logged and the result is None.

    Textures that share texels, or a file, share the image.
    """
    if texture.late is not None:
        return texture.late.made()
    if texture.texels is not None:
        return texture.texels
    try:
        images = [read_image(file) for file in texture.files]
    except DescriptionError as error:
        _log.warning("%s; the shape goes without texture", error)
        return None
    return _cube(texture.files, texture.layout) if texture.is_cube else images[0]


@functools.lru_cache(maxsize=64)
def _cube(files: tuple[object, ...], layout: tuple[str, ...]) -> Texels:
    """The six sides of a cube side by side."""
    images = [read_image(file) for file in files]  # pyright: ignore[reportArgumentType]
    if layout:
        whole, rows, columns = images[0], len(layout), len(layout[0])
        height, width = whole.shape[0] // rows, whole.shape[1] // columns
        parts = {
            letter: whole[row * height : (row + 1) * height, column * width : (column + 1) * width]
            for row, letters in enumerate(layout)
            for column, letter in enumerate(letters)
        }
        images = [parts.get(side, np.zeros((height, width, 3), np.uint8)) for side in _SIDES]
    elif len(images) == 1:
        # One above the other, as files have them where they are not square.
        whole = images[0]
        side = whole.shape[1]
        is_stack = whole.shape[0] == len(_SIDES) * side
        images = [whole[k * side : (k + 1) * side] if is_stack else whole for k in range(len(_SIDES))]
    side = max(max(image.shape[:2]) for image in images)
    made = np.concatenate([_resized(image, side) for image in images], axis=1)
    made.setflags(write=False)
    return made


def _resized(image: Texels, side: int) -> Texels:
    rows = np.arange(side) * image.shape[0] // side
    columns = np.arange(side) * image.shape[1] // side
    return image[rows][:, columns]


def with_texture(mesh: RenderMesh, geometry: Geometry, texture: Texture) -> RenderMesh:
    """The triangles of a shape with the texture coordinates that its texture needs."""
    if texture.is_cube:
        return _on_cube(mesh, texture)
    across, along = texture.repeat
    match geometry.texture_rule:
        case TextureRule.FROM_ABOVE:
            return _with(mesh, _on_plane(mesh, texture))
        case TextureRule.SIDES:
            return _with(mesh, _on_box(mesh, texture))
        case TextureRule.OWN_UPWARDS:
            reach = geometry.bounds(implicit_cylinder=True).half[2]
            upwards = 0.5 * (mesh.positions[:, 2] / reach + 1.0)
            return _with(mesh, np.column_stack([mesh.uvs[:, 0], upwards]) * np.array((across, along)))
        case TextureRule.OWN:
            return _with(mesh, mesh.uvs * np.array((across, along)))
        case TextureRule.FROM_ABOVE_OR_OWN:
            # Meshes have coordinates of their own; those that have none are seen from above.
            has_none = (mesh.uvs == NO_TEXTURE_UV).all()
            return _with(mesh, _on_plane(mesh, texture) if has_none else mesh.uvs)


def _with(mesh: RenderMesh, uvs: NDArray[np.floating]) -> RenderMesh:
    return RenderMesh(mesh.positions, mesh.normals, uvs.astype(np.float32), mesh.triangles)


def _on_plane(mesh: RenderMesh, texture: Texture) -> NDArray[np.float64]:
    """The image begins where the plane does; of one without end its middle is at the origin."""
    uvs = np.empty((len(mesh.positions), 2))
    for axis in range(2):
        half, repeat = texture.size[axis], texture.repeat[axis]
        place = mesh.positions[:, axis].astype(np.float64)
        if half == 0.0:
            uvs[:, axis] = 0.5 * repeat * place - 0.5
        else:
            uvs[:, axis] = 0.5 * repeat * (half if texture.uniform else 1.0) * (place / half + 1.0)
    return uvs


def _on_box(mesh: RenderMesh, texture: Texture) -> NDArray[np.float64]:
    """Each side has the whole image, with z upwards, or y on the upper and lower side."""
    normals, half = mesh.normals.astype(np.float64), np.array(texture.size)
    everyone = np.arange(len(normals))
    axis = np.abs(normals).argmax(axis=1)
    sign = np.sign(normals[everyone, axis])
    right, up = np.array((1, 0, 0))[axis], np.array((2, 2, 1))[axis]
    turns = np.where(axis == 1, -sign, sign)
    shares = mesh.positions / half
    uvs = 0.5 * (np.column_stack([turns * shares[everyone, right], shares[everyone, up]]) + 1.0)
    scale = np.array(texture.repeat)
    return uvs * (scale * half[np.column_stack([right, up])] if texture.uniform else scale)


def _on_cube(mesh: RenderMesh, texture: Texture) -> RenderMesh:
    """Separate triangles, cut where sides of the cube meet."""
    bounds = np.abs(mesh.positions).max(axis=0, initial=1e-9)
    half = np.array([length or bound for length, bound in zip(texture.size, bounds.tolist(), strict=True)])
    # Of each corner: its position, its normal, and the ray to it from the middle of the cube.
    rays = mesh.positions if texture.uniform else mesh.positions / half
    facts = np.concatenate([mesh.positions, mesh.normals, rays], axis=1).astype(np.float64)
    corners = facts[mesh.triangles]
    for plane in _BORDERS:
        corners = _cut(corners, corners[..., _RAYS] @ np.array(plane))
    rays = corners[..., _RAYS]
    middles = rays.mean(axis=1)
    axis = np.abs(middles).argmax(axis=1)
    side = 2 * axis + (middles[np.arange(len(rays)), axis] < 0.0)
    depth = np.maximum(np.abs(np.take_along_axis(rays, axis[:, None, None], axis=2)[..., 0]), 1e-9)
    right, right_sign, down, down_sign = (np.array(column)[side] for column in zip(*_AXES, strict=True))
    u = right_sign[:, None] * np.take_along_axis(rays, right[:, None, None], axis=2)[..., 0] / depth
    v = down_sign[:, None] * np.take_along_axis(rays, down[:, None, None], axis=2)[..., 0] / depth
    u, v = (np.clip(0.5 + 0.5 * part, _EDGE, 1.0 - _EDGE) for part in (u, v))
    uvs = np.stack([(side[:, None] + u) / len(_SIDES), 1.0 - v], axis=-1)
    return RenderMesh(
        np.ascontiguousarray(corners[..., :3].reshape(-1, 3), dtype=np.float32),
        np.ascontiguousarray(corners[..., 3:6].reshape(-1, 3), dtype=np.float32),
        uvs.reshape(-1, 2).astype(np.float32),
        np.arange(3 * len(corners), dtype=np.int32).reshape(-1, 3),
    )


def _cut(corners: NDArray[np.float64], heights: NDArray[np.float64]) -> NDArray[np.float64]:
    """Triangles (n, 3, ...) cut where the heights (n, 3) of their corners above a plane change their sign."""
    heights = np.where(np.abs(heights) < _ON_PLANE, 0.0, heights)
    signs = np.sign(heights)
    is_cut = (signs.min(axis=1) < 0.0) & (signs.max(axis=1) > 0.0)
    parts, heights, signs = corners[is_cut], heights[is_cut], signs[is_cut]
    # The corner that is alone on its side comes first; where one lies on the plane, one of the others does.
    alone = np.where(
        (signs == 0.0).any(axis=1),
        np.abs(signs).argmax(axis=1),
        (signs * signs.sum(axis=1, keepdims=True)).argmin(axis=1),
    )
    order = (alone[:, None] + np.arange(3)) % 3
    a, b, c = np.take_along_axis(parts, order[..., None], axis=1).transpose(1, 0, 2)
    high = np.take_along_axis(heights, order, axis=1)
    ab, ac = (
        a + (high[:, 0] / (high[:, 0] - high[:, k]))[:, None] * (other - a) for k, other in ((1, b), (2, c))
    )
    pieces = [np.stack(each, axis=1) for each in ((a, ab, ac), (ab, b, c), (ab, c, ac))]
    return np.concatenate([corners[~is_cut], *pieces])
