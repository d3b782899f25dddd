"""Boxes along the axes of a frame."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from carom.description.pose import Vector3
from carom.description.transform import Matrix3
from carom.native.arrays import ends

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray


def turned_box(
    center: Vector3, half: Vector3, rotation: Matrix3, position: Vector3
) -> tuple[Vector3, Vector3]:
    """Centre and half sizes of the bounds of a box after rotation and translation."""
    (xx, xy, xz), (yx, yy, yz), (zx, zy, zz) = rotation
    cx, cy, cz = center
    hx, hy, hz = half
    px, py, pz = position
    return (
        (
            xx * cx + xy * cy + xz * cz + px,
            yx * cx + yy * cy + yz * cz + py,
            zx * cx + zy * cy + zz * cz + pz,
        ),
        (
            abs(xx) * hx + abs(xy) * hy + abs(xz) * hz,
            abs(yx) * hx + abs(yy) * hy + abs(yz) * hz,
            abs(zx) * hx + abs(zy) * hy + abs(zz) * hz,
        ),
    )


class Bounds(NamedTuple):
    """An axis-aligned box.

    Attributes:
        center: Its centre [m].
        half: Half its size along each axis [m].
    """

    center: Vector3
    half: Vector3

    @classmethod
    def between(cls, low: Vector3, high: Vector3) -> Bounds:
        """The box with these corners."""
        return cls(
            (0.5 * (low[0] + high[0]), 0.5 * (low[1] + high[1]), 0.5 * (low[2] + high[2])),
            (0.5 * (high[0] - low[0]), 0.5 * (high[1] - low[1]), 0.5 * (high[2] - low[2])),
        )

    @classmethod
    def of_points(cls, points: NDArray[np.floating], scale: Vector3 = (1.0, 1.0, 1.0)) -> Bounds:
        """The bounds of points (n, 3), each multiplied by a scale."""
        return cls.between(*scaled_corners(points, scale))

    def grown(self, margin: float) -> Bounds:
        """The box, larger by a margin on every side."""
        x, y, z = self.half
        return Bounds(self.center, (x + margin, y + margin, z + margin))

    def placed(self, rotation: Matrix3, position: Vector3) -> Bounds:
        """Bounds of the box after rotation and translation."""
        return Bounds(*turned_box(self.center, self.half, rotation, position))

    def joined(self, other: Bounds) -> Bounds:
        """The bounding box of both boxes."""
        low = [
            min(a - h, b - k)
            for a, h, b, k in zip(self.center, self.half, other.center, other.half, strict=True)
        ]
        high = [
            max(a + h, b + k)
            for a, h, b, k in zip(self.center, self.half, other.center, other.half, strict=True)
        ]
        return Bounds.between((low[0], low[1], low[2]), (high[0], high[1], high[2]))


def scaled_corners(points: NDArray[np.floating], scale: Vector3) -> tuple[Vector3, Vector3]:
    """Lowest and highest corner of scaled points (n, 3)."""
    return scaled_ends(ends(points), scale)


def scaled_ends(corners: tuple[Vector3, Vector3], scale: Vector3) -> tuple[Vector3, Vector3]:
    """Lowest and highest corner of a box with these corners after scaling; a mirrored one is turned over."""
    (x0, y0, z0), (x1, y1, z1) = product(corners[0], scale), product(corners[1], scale)
    return (min(x0, x1), min(y0, y1), min(z0, z1)), (max(x0, x1), max(y0, y1), max(z0, z1))


def product(a: Vector3, b: Vector3) -> Vector3:
    """Products along x, y and z, as of two scales."""
    return (a[0] * b[0], a[1] * b[1], a[2] * b[2])
