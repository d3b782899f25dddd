"""Specifications of soft bodies, ready for the engine, and where they are in its arrays."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from carom.description.pose import Vector3
from carom.model.body_rows import TreeRows

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

# Columns of `SoftSpec.spring_terms`.
LENGTH, STIFFNESS, DAMPING = 0, 1, 2
# Largest thickness, relative to the shortest edge.
_SHARE_OF_EDGE = 0.4
SHORT = 1.0e-12
"""Springs and edges shorter than this fraction of the body's size count as having no length."""


@dataclass(eq=False, slots=True)
class Skin:
    """A mesh that follows the nodes of a soft body.

    Attributes:
        nodes: (v, k) nodes that each vertex follows.
        weights: (v, k) weights, which add up to 1.
        triangles: (t, 3) indices of its vertices.
    """

    nodes: NDArray[np.int32]
    weights: NDArray[np.float64]
    triangles: NDArray[np.int32]


@dataclass(eq=False, slots=True)
class SoftSpec:
    """Nodes, springs and tetrahedra.

    Attributes:
        nodes: (n, 3) rest positions in the frame of the body [m].
        masses: (n,) [kg].
        faces: (f, 3) nodes of the triangles of the surface, counter-clockwise from outside.
        springs: (s, 2) nodes of the springs.
        spring_terms: (s, 3) rest length [m], stiffness [N/m] and damping [N s/m] of each.
        tetras: (t, 4) nodes of the tetrahedra; their volumes are positive.
        mu: First Neo-Hookean parameter [Pa]; see `carom.kernels.soft.elasticity`.
        lam: Second one [Pa].
        damping: Viscosity of the tetrahedra divided by these parameters [s].
        damps_all_directions: Springs damp every relative motion of their ends, not only that along them.
        margin: Distance at which nodes rest on other surfaces [m].
        self_collision: Its nodes collide with its own faces.
        gravity_factor: Factor on the world's gravity.
        skin: The mesh that is drawn instead of the faces, if there is one.
        checkered: It has the checkered texture of floors until another is set.
    """

    nodes: NDArray[np.float64]
    masses: NDArray[np.float64]
    faces: NDArray[np.int32]
    springs: NDArray[np.int32]
    spring_terms: NDArray[np.float64]
    tetras: NDArray[np.int32]
    mu: float = 0.0
    lam: float = 0.0
    damping: float = 0.0
    damps_all_directions: bool = False
    margin: float = 0.02
    self_collision: bool = False
    gravity_factor: float = 1.0
    skin: Skin | None = None
    checkered: bool = False

    def edge_matrices(self) -> NDArray[np.float64]:
        """(t, 3, 3): the edges of each tetrahedron from its first node, as columns [m]."""
        import numpy as np

        corners = self.nodes[self.tetras]
        return np.swapaxes(corners[:, 1:] - corners[:, :1], 1, 2)

    def thickness(self) -> float:
        """Distance that nodes of soft bodies keep from its faces [m].

        The margin, but at most a fraction of the shortest edge at rest; edges without length are ignored.
        """
        import numpy as np

        corners = self.nodes[self.faces]
        if not len(corners):
            return self.margin
        edges = corners - np.roll(corners, 1, axis=1)
        lengths = np.linalg.norm(edges, axis=2)
        apart = lengths[lengths > SHORT * np.ptp(self.nodes, axis=0).max()]
        return min(self.margin, _SHARE_OF_EDGE * float(apart.min())) if len(apart) else self.margin

    def frequencies(self) -> NDArray[np.float64]:
        """(n,) upper bounds of the angular frequencies at which each node can vibrate [rad/s].

        By Gershgorin's theorem, the square is at most twice the stiffness of all springs at a node divided by
        its mass. Tetrahedra add their stiffness at each corner against stretching along one axis, where it
        is largest.
        """
        import numpy as np

        stiffness = self._at_nodes()
        for end in range(2):
            np.add.at(stiffness, self.springs[:, end], self.spring_terms[:, STIFFNESS])
        return np.sqrt(2.0 * stiffness / self.masses)

    def _at_nodes(self) -> NDArray[np.float64]:
        """(n,) stiffness of the tetrahedra around each node [N/m]."""
        import numpy as np

        from carom.native.products import determinants, inverses

        stiffness = np.zeros(len(self.nodes))
        if len(self.tetras):
            edges = self.edge_matrices()
            gradients = inverses(edges)
            gradients = np.concatenate([-gradients.sum(axis=1, keepdims=True), gradients], axis=1)
            volume = determinants(edges) / 6.0
            at_corner = (self.lam + 1.5 * self.mu) * volume[:, None] * (gradients**2).sum(axis=2)
            for corner in range(4):
                np.add.at(stiffness, self.tetras[:, corner], at_corner[:, corner])
        return stiffness


@dataclass(repr=False, eq=False, slots=True)
class SoftRows:
    """The rows of a soft body.

    Attributes:
        rows: Rows of the tree that represents it, which are updated elsewhere.
        spec: Its specification.
        first: First row on each axis.
        count: Rows on each axis.
    """

    rows: TreeRows
    spec: SoftSpec
    first: dict[str, int] = field(default_factory=dict)
    count: dict[str, int] = field(default_factory=dict)


@dataclass(repr=False, eq=False, slots=True)
class Anchor:
    """A node that is attached to a link or to the world.

    Attributes:
        id: Its number among the constraints of the world.
        soft: The soft body.
        node: Index of the node in the soft body, from 0.
        body: Rows of the body it is attached to; None for the world.
        link: Link of that body; -1 is the base.
        pivot: Point of attachment in the inertial frame of the link [m].
        damped: Whether damping within the soft body acts on the link, too.
        late_force: Share of the external force on a body without joints that acts after the node has
            followed it.
    """

    id: int
    soft: SoftRows
    node: int
    body: TreeRows | None
    link: int
    pivot: Vector3
    damped: bool = True
    late_force: float = 0.0
