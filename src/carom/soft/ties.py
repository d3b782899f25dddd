"""Springs that stand for what ties the nodes of a mesh: edges, constraints of their lengths, membranes."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from carom.description.compliance import Compliance
from carom.native.products import dots, length
from carom.soft.topology import edges_of

Floats = NDArray[np.float64]
Ints = NDArray[np.int32]
NETWORK_RATIO = 1.0 / 3.0
"""Poisson's ratio of a sheet of springs."""
_LEAST_TIME = 2.0
_TINY, _FLAT, _PAIR, _SINGULAR = 1e-30, 1e-6, 2, 1e-12
# Of a sheet whose Young's modulus times thickness is 1, by strains xx, yy and 2 xy.
_SHEET = np.array([[1.0, NETWORK_RATIO, 0.0], [NETWORK_RATIO, 1.0, 0.0], [0.0, 0.0, NETWORK_RATIO]]) / (
    1.0 - NETWORK_RATIO**2
)


class Ties:
    """The springs of a mesh, added up where several tie the same two nodes.

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

    def add_constraint(self, compliance: Compliance, masses: Floats, time_step: float) -> None:
        """Hold the length of each edge as a constraint does that yields, of nodes of these masses [kg].

        A constraint of impedance d, spring k and damper b, weighed for a mass m, is at rest where a spring
        of k d² m / (1 - d) is; as in MuJoCo, 1 / m is the mean of those of the nodes of an edge that are not
        pinned. The edge is taken to be so far from its length that its impedance is the greatest.
        """
        d = min(max(compliance.greatest, 1e-4), 0.9999)
        if compliance.time_constant > 0.0:
            time = max(compliance.time_constant, _LEAST_TIME * time_step)
            k = 1.0 / (d * time * compliance.damping_ratio) ** 2
            b = 2.0 / (d * time)
        else:
            k, b = -compliance.time_constant / d**2, -compliance.damping_ratio / d
        for a, c in self._edges.tolist():
            free = [float(masses[node]) for node in (a, c) if not self._held[node]]
            if free:
                # That of equal nodes is theirs to the last bit.
                mass = free[0] if free[0] == free[-1] else 2.0 / (1.0 / free[0] + 1.0 / free[1])
                share = d / (1.0 - d) * mass
                self._add(a, c, k * d * share, b * share)

    def add_membrane(self, young: float, damping: float) -> None:
        """Let triangles resist stretching as a sheet of Young's modulus times thickness `young` [N/m].

        Its Poisson's ratio is 1/3, as it is of all sheets of springs. Of two triangles with the same longest
        edge, the far corners are tied as well, as the other diagonal of a cell is, if they lie in a plane
        and form a convex quadrangle.
        """
        across = self._across()
        for number, corners in enumerate(self._cells.tolist()):
            pairs = [(corners[i], corners[j]) for i, j in ((0, 1), (1, 2), (2, 0))] + across[number]
            axes, area = self._in_plane(corners)
            columns = []
            for first, second in pairs:
                x, y = (float(dots(axis, self._nodes[second] - self._nodes[first])) for axis in axes)
                # Energy of a spring of stiffness 1 by the strains xx, yy and 2 xy: half of this squared.
                along = np.array([x * x, y * y, x * y]) / max(x * x + y * y, _TINY) ** 0.5
                columns.append(_six(along[:, None] * along))
            wanted = _six(area * young * _SHEET)
            for (first, second), stiffness in zip(pairs, _least_squares(columns, wanted), strict=True):
                self._add(first, second, stiffness, damping * stiffness)

    def made(self) -> tuple[Ints, Floats]:
        """Pairs of nodes (s, 2), and rest length, stiffness and damping of each (s, 3)."""
        if not self._terms:
            return np.empty((0, 2), np.int32), np.empty((0, 3))
        pairs = np.array(sorted(self._terms), np.int32)
        lengths = np.linalg.norm(self._nodes[pairs[:, 1]] - self._nodes[pairs[:, 0]], axis=1)
        terms = np.array([self._terms[a, b] for a, b in pairs.tolist()])
        return pairs, np.concatenate([lengths[:, None], terms], axis=1)

    def _add(self, a: int, b: int, stiffness: float, damping: float) -> None:
        if (self._held[a] and self._held[b]) or not (stiffness or damping):
            return
        terms = self._terms.setdefault((min(a, b), max(a, b)), [0.0, 0.0])
        terms[0] += stiffness
        terms[1] += damping

    def _in_plane(self, corners: list[int]) -> tuple[tuple[Floats, Floats], float]:
        """Two axes in the plane of a triangle, and its area [m²]."""
        a, b, c = self._nodes[corners]
        x = (b - a) / max(length(b - a), _TINY)
        normal = np.cross(b - a, c - a)
        twice = length(normal)
        y = np.asarray(np.cross(normal / max(twice, _TINY), x), dtype=np.float64)
        return (x, y), 0.5 * twice

    def _across(self) -> list[list[tuple[int, int]]]:
        """Of each triangle, the pair of far corners across its longest edge, if its neighbour has it, too."""
        sides: dict[tuple[int, int], list[tuple[int, int]]] = {}
        longest: list[tuple[int, int]] = []
        for number, corners in enumerate(self._cells.tolist()):
            edges = [tuple(sorted((corners[i], corners[i - 1]))) for i in range(3)]
            for place, (a, b) in enumerate(edges):
                sides.setdefault((a, b), []).append((number, corners[place - 2]))
            sizes = [length(self._nodes[a] - self._nodes[b]) for a, b in edges]
            a, b = edges[int(np.argmax(np.round(sizes, 9)))]
            longest.append((a, b))
        found: list[list[tuple[int, int]]] = [[] for _ in self._cells]
        for number, edge in enumerate(longest):
            both = sides[edge]
            if len(both) != _PAIR or longest[both[0][0]] != longest[both[1][0]] or both[0][0] != number:
                continue
            (one, far), (other, opposite) = both
            if self._is_convex(edge, far, opposite):
                found[one].append((far, opposite))
                found[other].append((far, opposite))
        return found

    def _is_convex(self, edge: tuple[int, int], far: int, opposite: int) -> bool:
        """Whether the line between two nodes meets an edge, but for rounding, within both."""
        a, b, c, d = self._nodes[[*edge, far, opposite]]
        normal = np.cross(b - a, c - a)
        size = length(normal)
        if abs(float(dots(normal, d - a))) > _FLAT * size * length(b - a):
            return False
        of_a = float(dots(np.cross(a - c, d - c), normal))
        of_b = float(dots(np.cross(b - c, d - c), normal))
        return of_a * of_b < -_FLAT * size**4


def _six(symmetric: Floats) -> Floats:
    """The entries of a symmetric matrix, so that their squares add up to those of the matrix."""
    rows, columns = np.triu_indices(3)
    return symmetric[rows, columns] * np.where(rows == columns, 1.0, 2.0**0.5)


def _combined(columns: list[Floats], wanted: Floats) -> list[float]:
    """Factors of columns whose sum is nearest to what is wanted; the least ones, where several are."""
    rows = [[float(dots(a, b)) for b in columns] + [float(dots(a, wanted))] for a in columns]
    count, least = len(rows), _SINGULAR * max(rows[k][k] for k in range(len(rows)))
    for k in range(count):
        rows[k][k] += least
    for k in range(count):
        for i in range(k + 1, count):
            factor = rows[i][k] / rows[k][k]
            rows[i] = [a - factor * b for a, b in zip(rows[i], rows[k], strict=True)]
    found = [0.0] * count
    for k in reversed(range(count)):
        known = sum(rows[k][i] * found[i] for i in range(k + 1, count))
        found[k] = (rows[k][count] - known) / rows[k][k]
    return found


def _least_squares(columns: list[Floats], wanted: Floats) -> list[float]:
    """Factors of columns, none of them negative, whose sum is nearest to what is wanted."""
    used = list(range(len(columns)))
    factors = [0.0] * len(columns)
    while used:
        found = _combined([columns[each] for each in used], wanted)
        if min(found) >= 0.0:
            for each, value in zip(used, found, strict=True):
                factors[each] = value
            break
        used.pop(found.index(min(found)))
    return factors
