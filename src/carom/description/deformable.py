"""A deformable body as a URDF file describes it."""

from __future__ import annotations

from pathlib import Path

from carom.record import record


@record
class SpringCoefficients:
    """`<spring>`: along the edges of cells.

    Attributes:
        elastic: [N/m].
        damping: [N s/m].
        bending: Between nodes with a neighbour in common [N/m]; 0 for none.
    """

    elastic: float
    damping: float
    bending: float = 0.0


@record
class LameCoefficients:
    """`<neohookean>` or `<corotated>`: of tetrahedra.

    Attributes:
        mu: First coefficient [Pa].
        lam: Second one [Pa].
        damping: Viscosity as a share of these [s].
    """

    mu: float
    lam: float
    damping: float = 0.0


@record
class Deformable:
    """`<deformable>` or `<reduced_deformable>`.

    Attributes:
        visual: The mesh that is seen, and simulated if there is no other.
        mass: Of all nodes together [kg].
        margin: Distance at which nodes rest on other surfaces [m].
        friction: Coulomb coefficient.
        simulated: The mesh that is simulated.
        gravity_factor: Share of the world's gravity that pulls it.
        springs: Springs, if there are any.
        neo_hookean: What its tetrahedra are like for any strain.
        corotated: The material for small strains.
        stiffness_scale: Of a reduced body: factor on the stiffness of its modes.
        mode_damping: Of a reduced body: its damping, as a share of that stiffness [s].
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
