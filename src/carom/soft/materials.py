"""Materials of soft bodies."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Springs:
    """Springs along the edges of cells.

    Attributes:
        stiffness: [N/m].
        damping: [N s/m], also of the springs against bending.
        bending: Stiffness of springs between nodes with a common neighbour [N/m]; 0 for no such springs.
        damps_all_directions: They damp all relative motion of their ends, not only that along the spring.
    """

    stiffness: float
    damping: float = 0.0
    bending: float = 0.0
    damps_all_directions: bool = False


@dataclass(frozen=True, slots=True)
class NeoHookean:
    """A solid with the energy of Smith, de Goes and Kim (2018), as in Bullet.

    Attributes:
        mu: [Pa]; for small strains the shear modulus is 3/4 `mu`.
        lam: [Pa]; for small strains Lamé's first parameter is `lam` minus 5/8 `mu`.
        damping: Viscosity divided by these moduli [s].
    """

    mu: float
    lam: float
    damping: float = 0.0

    @classmethod
    def of(cls, youngs_modulus: float, poissons_ratio: float, damping: float = 0.0) -> NeoHookean:
        """A material with this Young's modulus [Pa] and Poisson's ratio for small strains."""
        shear = youngs_modulus / (2.0 * (1.0 + poissons_ratio))
        return cls.of_lame(shear, 2.0 * shear * poissons_ratio / (1.0 - 2.0 * poissons_ratio), damping)

    @classmethod
    def of_lame(cls, shear: float, first: float, damping: float = 0.0) -> NeoHookean:
        """A material with this shear modulus and Lamé's first parameter for small strains [Pa]."""
        return cls(4.0 / 3.0 * shear, first + 5.0 / 6.0 * shear, damping)
