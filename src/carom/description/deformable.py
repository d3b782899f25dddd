"""A deformable body as a URDF file describes it."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path


@dataclass(frozen=True, slots=True)
class SpringCoefficients:
    """`<spring>`: springs along the edges of cells.

    Attributes:
        elastic: Stiffness [N/m].
        damping: Damping coefficient [N s/m].
        bending: Stiffness of springs between nodes with a neighbour in common [N/m]; 0 for none.
    """

    elastic: float
    damping: float
    bending: float = 0.0


@dataclass(frozen=True, slots=True)
class LameCoefficients:
    """`<neohookean>` or `<corotated>`: Lamé coefficients of tetrahedra.

    Attributes:
        mu: Coefficient μ [Pa].
        lam: Coefficient λ [Pa].
        damping: Viscosity divided by these coefficients [s].
    """

    mu: float
    lam: float
    damping: float = 0.0


@dataclass(frozen=True, slots=True)
class Deformable:
    """`<deformable>` or `<reduced_deformable>`.

    Attributes:
        visual: The visual mesh; it is also simulated if `simulated` is None.
        mass: Mass of all nodes together [kg].
        margin: Distance at which nodes rest on other surfaces [m].
        friction: Coulomb coefficient.
        simulated: The mesh that is simulated.
        gravity_factor: Factor on the world's gravity.
        springs: Springs, if there are any.
        neo_hookean: Neo-Hookean material of its tetrahedra, for strains of any size.
        corotated: Corotated material of its tetrahedra, for small strains.
        stiffness_scale: Factor on the stiffness of the modes of a reduced body; None for other bodies.
        mode_damping: Damping of the modes of a reduced body divided by their stiffness [s].
    """

    visual: Path
    mass: float
    margin: float
    friction: float
    simulated: Path | None = None
    gravity_factor: float = 1.0
    springs: SpringCoefficients | None = None
    neo_hookean: LameCoefficients | None = None
    corotated: LameCoefficients | None = None
    stiffness_scale: float | None = None
    mode_damping: float = 0.0
