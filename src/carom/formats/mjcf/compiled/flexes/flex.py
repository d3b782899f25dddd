"""A flex as it is compiled."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from carom.description.compliance import Compliance
from carom.description.link import Material
from carom.description.pose import IDENTITY, Pose


@dataclass(eq=False, slots=True)
class FileFlex:
    """Nodes, what ties them, and which of them a body holds.

    Attributes:
        name: Its name; made up if it has none.
        body: Name of the body around it; `world` for the world.
        nodes: (n, 3) positions in the frame of that body [m].
        cells: (m, 2) edges, (m, 3) triangles or (m, 4) tetrahedra.
        pins: Names of the bodies that hold nodes, by node.
        masses: (n,) of the nodes [kg]; those of nodes that a body holds do not count.
        radius: Distance at which nodes rest on other surfaces [m].
        friction: Coulomb coefficient.
        edge_stiffness: Of a spring along each edge [N/m].
        edge_damping: Of a damper along each edge [N s/m].
        edges: How the length of each edge is held; None if it is not.
        young: Young's modulus of tetrahedra [Pa], or that of triangles times their thickness [N/m]; 0 if they
            do not resist deformation.
        poisson: Poisson's ratio of tetrahedra.
        damping: Viscosity divided by these moduli [s].
        collides: Its nodes rest on other surfaces.
        self_collision: Its nodes collide with its own faces.
        material: How it looks.
        pose: World pose of the body where the file has it.
        bodies: Names of the bodies that are nodes, by node, of flexes whose file lists them.
        turns: World poses of these bodies where the file has them; they do not turn.
    """

    name: str
    body: str
    nodes: NDArray[np.float64]
    cells: NDArray[np.int32]
    pins: dict[int, str]
    masses: NDArray[np.float64]
    radius: float
    friction: float = 1.0
    edge_stiffness: float = 0.0
    edge_damping: float = 0.0
    edges: Compliance | None = None
    young: float = 0.0
    poisson: float = 0.0
    damping: float = 0.0
    collides: bool = True
    self_collision: bool = False
    material: Material | None = None
    pose: Pose = IDENTITY
    bodies: dict[int, str] = field(default_factory=dict)
    turns: dict[int, Pose] = field(default_factory=dict)

    def body_names(self) -> dict[str, int]:
        """The nodes that no body holds, by the names of their bodies in MuJoCo."""
        free = [node for node in range(len(self.nodes)) if node not in self.pins]
        return {self.bodies.get(node, f"{self.name}_{node}"): node for node in free}
