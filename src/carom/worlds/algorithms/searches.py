"""Inverse kinematics of a body in many worlds, in one native call on each thread."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from carom.algorithms.inverse_kinematics import MAX_ITERATIONS, SearchTable
from carom.checks import Array
from carom.engine.world_calls import WorldCalls
from carom.layouts.chain import SearchBatch
from carom.native.kernels import searches_in_worlds_kernel
from carom.native.launch import Launch
from carom.native.tables import put_array, put_zeros
from carom.scene.body import Body


class InverseKinematicsBatch(NamedTuple):
    """What inverse kinematics found in each of n worlds.

    Attributes:
        positions: The best joint positions found, (n, coordinates); a quaternion (x, y, z, w) for each
            spherical joint.
        residuals: Largest distance that is left between a link and its target [m], (n,).
        angle_residuals: Largest angle that is left [rad], (n,); 0 if no orientations were asked for.
        success: Whether no residual is above the threshold, (n,).
    """

    positions: Array
    residuals: Array
    angle_residuals: Array
    success: NDArray[np.bool_]


class SearchOptions(NamedTuple):
    """The numbers of `inverse_kinematics_kernel` that all worlds share, in the order of arguments."""

    oriented: bool
    step_kind: int
    bounded: bool
    iterations: int
    further: int
    threshold: float
    patience: float


class Searcher:
    """Inverse kinematics for some links of a body of a scene, of which the worlds are copies.

    Args:
        body: The body.
        links: Indices of the links; -1 is the base.
        threads: Number of threads.
    """

    def __init__(self, body: Body, links: Sequence[int], threads: int) -> None:
        self._tables = [SearchTable(body, tuple(links)) for _ in range(threads)]
        self._calls = WorldCalls(threads)
        self.dofs: int = int(self._tables[0].chain.sizes.dofs)

    def __call__(self, given: dict[str, np.ndarray], options: SearchOptions) -> InverseKinematicsBatch:
        """Search.

        Args:
            given: The fields of `SearchBatch` but for the results; the first axis of each is the world.
            options: The options.
        """
        count, coordinates = given["start"].shape
        batch: Any = SearchBatch()
        for name, values in given.items():
            put_array(batch, name, values)
        best = put_zeros(batch, "best", count * coordinates).reshape(count, coordinates)
        left = put_zeros(batch, "residual", 2 * count).reshape(count, 2)
        limited = options._replace(
            iterations=min(options.iterations, MAX_ITERATIONS), further=min(options.further, MAX_ITERATIONS)
        )
        launches = [
            [Launch(searches_in_worlds_kernel, 1, [*table.structs, batch, *limited, 0])]
            for table in self._tables
        ]
        # Searches take very different times.
        self._calls.run(count, launches, chunk=1)
        distances, angles = left[:, 0].copy(), left[:, 1].copy()
        success = (distances <= options.threshold) & (angles <= options.threshold)
        return InverseKinematicsBatch(best, distances, angles, success)
