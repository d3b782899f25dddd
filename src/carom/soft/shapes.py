"""Meshes of simple shapes."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from carom.native.products import determinants, dots

Floats = NDArray[np.float64]
Ints = NDArray[np.int32]

# Six tetrahedra of a cube, around the diagonal from corner 0 to 7. Bits 0, 1, 2 of a corner are its x, y, z.
_IN_CUBE = ((0, 1, 3, 7), (0, 3, 2, 7), (0, 2, 6, 7), (0, 6, 4, 7), (0, 4, 5, 7), (0, 5, 1, 7))


def grid(size: tuple[float, float], cells: tuple[int, int]) -> tuple[Floats, Ints]:
    """A rectangle in the plane z = 0, centred on the origin: size [m] and number of cells along x and y.

    Returns:
        ((n, 3) nodes, x fastest; (f, 3) triangles with normals along z, two for each cell).
    """
    nx, ny = cells[0] + 1, cells[1] + 1
    x, y = np.meshgrid(np.linspace(-0.5, 0.5, nx) * size[0], np.linspace(-0.5, 0.5, ny) * size[1])
    nodes = np.stack([x.ravel(), y.ravel(), np.zeros(nx * ny)], axis=1)
    corner = (np.arange(ny - 1)[:, None] * nx + np.arange(nx - 1)).ravel()
    first = np.stack([corner, corner + 1, corner + nx + 1], axis=1)
    second = np.stack([corner, corner + nx + 1, corner + nx], axis=1)
    return nodes, np.stack([first, second], axis=1).reshape(-1, 3).astype(np.int32)


def box(size: tuple[float, float, float], cells: tuple[int, int, int]) -> tuple[Floats, Ints]:
    """A cuboid centred on the origin: size [m] and number of cells along x, y and z; six tetrahedra in each.

    Returns:
        ((n, 3) nodes, x fastest; (t, 4) tetrahedra of positive volume).
    """
    counts = [count + 1 for count in cells]
    z, y, x = np.meshgrid(
        *(np.linspace(-0.5, 0.5, counts[axis]) * size[axis] for axis in (2, 1, 0)), indexing="ij"
    )
    nodes = np.stack([x.ravel(), y.ravel(), z.ravel()], axis=1)
    k, j, i = np.meshgrid(*(np.arange(cells[axis]) for axis in (2, 1, 0)), indexing="ij")
    origin = ((k * counts[1] + j) * counts[0] + i).ravel()
    step = np.array([1, counts[0], counts[0] * counts[1]])
    corners = dots(np.array([[bits & 1, bits >> 1 & 1, bits >> 2] for bits in range(8)]), step)
    return nodes, (origin[:, None, None] + corners[np.array(_IN_CUBE)]).reshape(-1, 4).astype(np.int32)


def ball(radius: float, cells: int) -> tuple[Floats, Ints]:
    """A ball of tetrahedra around the origin: a cube of cells whose cubic layers are mapped to spheres.

    Returns:
        ((n, 3) nodes; (t, 4) tetrahedra of positive volume).
    """
    nodes, tetras = box((2.0, 2.0, 2.0), (cells, cells, cells))
    most = np.abs(nodes).max(axis=1, keepdims=True)
    length = np.linalg.norm(nodes, axis=1, keepdims=True)
    round_nodes = nodes * radius * np.divide(most, length, out=np.zeros_like(most), where=length > 0.0)
    return round_nodes, oriented(round_nodes, tetras)


def oriented(nodes: Floats, tetras: Ints) -> Ints:
    """The same tetrahedra, with two corners swapped in those of negative volume."""
    corners = nodes[tetras]
    volumes = determinants(corners[:, 1:] - corners[:, :1])
    turned = tetras.copy()
    turned[volumes < 0.0, 2], turned[volumes < 0.0, 3] = tetras[volumes < 0.0, 3], tetras[volumes < 0.0, 2]
    return turned
