"""Vectors (..., 3) and quaternions (..., 4) of many worlds.

Sums are written out, so that a world gives the same bits alone and among others.
"""

from __future__ import annotations

import numpy as np

from carom.checks import Array


def stacked(*components: Array) -> Array:
    """Vectors from their components."""
    first = components[0]
    for component in components:
        if component.shape != first.shape or component.dtype != first.dtype:
            return np.stack(np.broadcast_arrays(*components), axis=-1)
    # The usual case takes a quarter of the time.
    made = np.empty((*first.shape, len(components)), dtype=first.dtype)
    for place, component in enumerate(components):
        made[..., place] = component
    return made


def dot(a: Array, b: Array) -> Array:
    """Products of vectors."""
    return a[..., 0] * b[..., 0] + a[..., 1] * b[..., 1] + a[..., 2] * b[..., 2]


def cross(a: Array, b: Array) -> Array:
    """Cross products of vectors."""
    return stacked(
        a[..., 1] * b[..., 2] - a[..., 2] * b[..., 1],
        a[..., 2] * b[..., 0] - a[..., 0] * b[..., 2],
        a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0],
    )


def turned(q: Array, v: Array) -> Array:
    """Vectors turned by unit quaternions (x, y, z, w)."""
    axis, w = q[..., :3], q[..., 3:]
    twice = cross(axis, v) * 2.0
    return v + w * twice + cross(axis, twice)


def conjugate(q: Array) -> Array:
    """Conjugates of quaternions."""
    return q * np.array([-1.0, -1.0, -1.0, 1.0])


def turned_back(q: Array, v: Array) -> Array:
    """Vectors turned by the inverses of unit quaternions."""
    return turned(conjugate(q), v)


def product(a: Array, b: Array) -> Array:
    """Products of quaternions."""
    ax, ay, az, aw = (a[..., k] for k in range(4))
    bx, by, bz, bw = (b[..., k] for k in range(4))
    return stacked(
        aw * bx + ax * bw + ay * bz - az * by,
        aw * by - ax * bz + ay * bw + az * bx,
        aw * bz + ax * by - ay * bx + az * bw,
        aw * bw - ax * bx - ay * by - az * bz,
    )
