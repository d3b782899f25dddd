"""Springs that act as MuJoCo's edges of flexes do: as springs, dampers, constraints and membranes."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from carom.description.compliance import Compliance
from carom.native.products import length
from carom.soft.topology import edges_of

Floats = NDArray[np.float64]
Ints = NDArray[np.int32]
NETWORK_RATIO = 1.0 / 3.0
"""Poisson's ratio of a sheet of springs."""
_LEAST_TIME = 2.0


class Ties:
    """The springs of a flex, added up where several tie the same two nodes.

    Args:
        nodes: (n, 3) [m].
        cells: (m, k) edges, triangles or tetrahedra.
        held: (n,) whether each node is pinned: springs between two of these have no effect.
    """

    def __init__(self, nodes: Floats, cells: Ints, held: NDArray[np.bool_]) -> None:
        self._nodes, self._cells, self._held = nodes, cells, held
        self._terms: dict[tuple[int, int], list[float]] = {}
        self._edges = edges_of(cells)

    def add_edges(self, stiffness: float, damping: float) -> None:
        """Tie the ends of each edge [N/m, N s/m]."""
        for a, b in self._edges.tolist():
            self._add(a, b, stiffness, damping)

    def add_constraint(self, compliance: Compliance, mass: float, time_step: float) -> None:
        """Hold the length of each edge as a constraint does that yields, of nodes of this mass [kg].

        A constraint of impedance d, spring k and damper b that moves an inverse mass A is at rest where a
        spring of k d² / ((1 - d) A) is. It is taken as far from its length as its impedance is the greatest.
        """
        d = min(max(compliance.greatest, 1e-4), 0.9999)
        if compliance.time_constant > 0.0:
            time = max(compliance.time_constant, _LEAST_TIME * time_step)
            k = 1.0 / (d * time * compliance.damping_ratio) ** 2
            b = 2.0 / (d * time)
        else:
            k, b = -compliance.time_constant / d**2, -compliance.damping_ratio / d
        for a, b_node in self._edges.tolist():
            inverse = ((not self._held[a]) + (not self._held[b_node])) / mass
            if inverse:
                share = d / ((1.0 - d) * inverse)
                self._add(a, b_node, k * d * share, b * share)

    def add_membrane(self, young: float, damping: float) -> None:
        """Let triangles resist stretching as a sheet of Young's modulus times thickness `young` [N/m].

        Its Poisson's ratio is 1/3, as it is of all sheets of springs. The two triangles on an edge have a
        spring between their far corners as well if they lie in a plane and make a convex quadrangle.
        """
        across = self._across()
        for triangle, corners in enumerate(self._cells.tolist()):
            pairs = [(corners[i], corners[j]) for i, j in ((0, 1), (1, 2), (2, 0))]
            pairs += [pair for pair, both in across.items() if triangle in both]
            self._add_sheet(corners, pairs, young, damping)

    def made(self) -> tuple[Ints, Floats]:
        """Pairs of nodes (s, 2), and rest length, stiffness and damping of each (s, 3)."""
        if not self._terms:
            return np.empty((0, 2), np.int32), np.empty((0, 3))
        pairs = np.array(sorted(self._terms), np.int32)
        lengths = length(self._nodes[pairs[:, 1]] - self._nodes[pairs[:, 0]])
        terms = np.array([self._terms[a, b] for a, b in pairs.tolist()])
        return pairs, np.concatenate([lengths[:, None], terms], axis=1)

    def _add(self, a: int, b: int, stiffness: float, damping: float) -> None:
        if (self._held[a] and self._held[b]) or not (stiffness or damping):
            return
        terms = self._terms.setdefault((min(a, b), max(a, b)), [0.0, 0.0])
        terms[0] += stiffness
        terms[1] += damping
