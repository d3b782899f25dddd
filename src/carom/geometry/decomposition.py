"""Approximate convex decomposition of solids, by the library CoACD."""

from __future__ import annotations

from dataclasses import dataclass
from importlib import import_module

import numpy as np
from numpy.typing import NDArray

from carom.errors import CaromError


@dataclass(frozen=True, slots=True)
class DecompositionOptions:
    """How finely a solid is cut.

    Attributes:
        threshold: Largest concavity of a piece, from 0.01 (fine) to 1 (coarse).
        grid: Cells along the longest side of the grid that turns an open mesh into a closed surface.
        most_vertices: Maximum number of vertices of each piece.
        align: Rotate the solid to its principal axes before cutting.
    """

    threshold: float = 0.05
    grid: int = 50
    most_vertices: int = 64
    align: bool = False


def decompose(
    vertices: NDArray[np.float64], triangles: NDArray[np.int32], options: DecompositionOptions
) -> list[tuple[NDArray[np.float64], NDArray[np.int32]]]:
    """Cuts a solid, (n, 3) vertices and (m, 3) triangles counter-clockwise from outside, into convex pieces.

    Returns:
        Vertices and triangles of each piece.

    Raises:
        CaromError: CoACD is not installed.
    """
    try:
        coacd = import_module("coacd")
    except ImportError:
        raise CaromError(
            "this needs the library CoACD; install it with: pip install 'carom[decompose]'"
        ) from None
    coacd.set_log_level("error")
    pieces = coacd.run_coacd(
        coacd.Mesh(vertices, triangles),
        threshold=options.threshold,
        preprocess_resolution=options.grid,
        pca=options.align,
        decimate=True,
        max_ch_vertex=options.most_vertices,
    )
    return [(np.asarray(points, np.float64), np.asarray(corners, np.int32)) for points, corners in pieces]
