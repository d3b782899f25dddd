"""A flex as it is compiled."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from carom.description.link import Material
from carom.description.pose import IDENTITY, Pose


@dataclass(eq=False, slots=True)
class FileFlex:
    """Nodes, what ties them, and which of them a body holds.

    Attributes:
        name: Its name; made up if it has none.
        body: Name of the body around it, which holds the nodes that are pinned; `world` for the world.
        nodes: (n, 3) positions in the frame of that body [m].
        cells: (m, 2) edges, (m, 3) triangles or (m, 4) tetrahedra of positive volume.
        pins: Nodes that the body holds, ascending.
        mass: Of each node [kg].
        radius: Distance at which nodes rest on other surfaces [m].
        friction: Coulomb coefficient.
        springs: (s, 2) nodes of springs.
        spring_terms: (s, 3) rest length [m], stiffness [N/m] and damping [N s/m] of each.
        young: Young's modulus of tetrahedra [Pa]; 0 if they do not resist deformation.
        poisson: Their Poisson's ratio.
        damping: Their viscosity divided by these moduli [s].
        collides: Its nodes rest on other surfaces.
        self_collision: Its nodes collide with its own faces.
        material: How it looks.
        pose: World pose of the body where the file has it.
    """

    name: str
    body: str
    nodes: NDArray[np.float64]
    cells: NDArray[np.int32]
    pins: tuple[int, ...]
    mass: float
    radius: float
    friction: float
    springs: NDArray[np.int32]
    spring_terms: NDArray[np.float64]
    young: float = 0.0
    poisson: float = 0.0
    damping: float = 0.0
    collides: bool = True
    self_collision: bool = False
    material: Material | None = field(default=None)
    pose: Pose = IDENTITY
