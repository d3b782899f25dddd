"""Polygons cut into triangles as MuJoCo cuts those of OBJ files, by rules that decide in single precision.

Quadrangles are cut along the shorter diagonal. Of others, corner after corner is cut off that looks like an
ear, in the plane of two axes of the file. What tells the inside from the outside there is the triangle of the
origin and the first edge of the ear: so the cut depends on where the mesh lies, and may leave triangles that
overlap. Polygons for which no ear is found lose what is left of them.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from carom.files.budget import check_time

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Singles = NDArray[np.float32]
    Corners = NDArray[np.int64]

_FLAT = float(np.finfo(np.float32).eps)
_HALF = np.float32(0.5)


def cut_by_ears(positions: NDArray[np.float64], corners: Corners, sizes: Corners) -> Corners:
    """Triangles (m, 3) of polygons, in their order; those with fewer than three corners vanish.

    `corners` are those of all polygons, one after the other, as indices of `positions` (n, 3), and `sizes`
    the number of corners of each.
    """
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        return _cut(positions, corners, sizes)


def _cut(positions: NDArray[np.float64], corners: Corners, sizes: Corners) -> Corners:
    starts, points = np.cumsum(sizes) - sizes, positions.astype(np.float32)
    triangles: list[Corners] = [np.empty((0, 3), dtype=np.int64)]
    owners: list[Corners] = [np.empty(0, dtype=np.int64)]
    for size in np.unique(sizes).tolist():
        if size < 3:
            continue
        polygons = np.flatnonzero(sizes == size)
        own = corners[starts[polygons][:, None] + np.arange(size)]
        if size == 3:
            found, counts = own, np.ones(len(own), dtype=np.int64)
        elif size == 4:
            found, counts = _halves(points, own), np.full(len(own), 2)
        else:
            found, counts = _ears(points, own)
        triangles.append(found)
        owners.append(np.repeat(polygons, counts))
    return np.concatenate(triangles)[np.argsort(np.concatenate(owners), kind="stable")]


def _halves(points: Singles, quads: Corners) -> Corners:
    """The triangles of quadrangles (n, 4), two of each."""
    a, b, c, d = (points[quads[:, corner]] for corner in range(4))
    shorter = (_squares(c - a) < _squares(d - b))[:, None]
    first = np.where(shorter, quads[:, [0, 1, 2]], quads[:, [0, 1, 3]])
    second = np.where(shorter, quads[:, [0, 2, 3]], quads[:, [1, 2, 3]])
    return np.stack([first, second], axis=1).reshape(-1, 3)


def _squares(vectors: Singles) -> Singles:
    x, y, z = vectors.T
    return x * x + y * y + z * z


def _ears(points: Singles, polygons: Corners) -> tuple[Corners, Corners]:
    """The triangles of polygons (n, k), those of each together, and how many each has."""
    count, size = polygons.shape
    flat = np.take_along_axis(points[polygons], _planes(points[polygons]), axis=2)
    steps = np.arange(size)
    # Of each polygon: places of the corners that are left, their number, and where the next ear is sought.
    left = np.tile(steps, (count, 1))
    sizes, at = np.full(count, size), np.zeros(count, dtype=np.int64)
    tries, is_new = sizes.copy(), np.zeros(count, dtype=bool)
    found, counts = np.zeros((count, size - 2, 3), dtype=np.int64), np.zeros(count, dtype=np.int64)
    while len(now := np.flatnonzero((sizes > 3) & (tries > 0))):
        check_time()
        # An ear that is found with the last try is the last one, too.
        tries[now] = np.where(is_new[now], sizes[now], tries[now] - 1)
        at[now] %= sizes[now]
        order = (at[now, None] + steps) % sizes[now, None]
        others = np.take_along_axis(left[now], order, axis=1)
        is_new[now] = fits = _are_ears(flat[now[:, None], others], steps[3:] < sizes[now, None])
        at[now] += ~fits
        cut, gone = now[fits], order[fits, 1]
        found[cut, counts[cut]] = others[fits, :3]
        counts[cut] += 1
        sizes[cut] -= 1
        kept = np.minimum(steps + (steps >= gone[:, None]), size - 1)
        left[cut] = np.take_along_axis(left[cut], kept, axis=1)
    rest = sizes == 3
    found[rest, counts[rest]] = left[rest, :3]
    counts[rest] += 1
    places = found[np.arange(size - 2) < counts[:, None]]
    return polygons[np.repeat(np.arange(count), counts)[:, None], places], counts


def _planes(points: Singles) -> Corners:
    """For polygons (n, k, 3) the two axes (n, 1, 2) of the plane in which ears are sought.

    They are those across the greatest part of the normal at the first corner that has one.
    """
    edges = np.roll(points, -1, axis=1) - points
    normals = np.abs(np.cross(edges, np.roll(edges, -1, axis=1)))
    has_one = (normals > _FLAT).any(axis=2)
    x, y, z = normals[np.arange(len(points)), has_one.argmax(axis=1)].T
    by_z, by_x = (z > x) & (z > y), ((x > y) & (x > z)) | ~has_one.any(axis=-1)
    first, second = np.where(by_x, 1, 0), np.where(by_z & ~by_x, 1, 2)
    return np.stack([first, second], axis=1)[:, None]


def _are_ears(points: Singles, counts: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Whether the first three of corners (n, k, 2) turn as they should, with no other corner inside.

    `counts` (n, k - 3) says which of the others there are.
    """
    (ax, ay), (bx, by), (cx, cy) = (points[:, corner].T for corner in range(3))
    turns = (bx - ax) * (cy - by) - (by - ay) * (cx - bx)
    is_right = ~(turns * ((ax * by - ay * bx) * _HALF) < 0.0)
    x, y = points[:, 3:, 0], points[:, 3:, 1]
    inside = np.zeros(x.shape, dtype=bool)
    for p, q in ((0, 2), (1, 0), (2, 1)):
        (px, py), (qx, qy) = (points[:, corner].T[..., None] for corner in (p, q))
        crosses = x < (qx - px) * (y - py) / (qy - py) + px
        inside ^= ((py > y) != (qy > y)) & crosses
    return is_right & ~(inside & counts).any(axis=-1)
