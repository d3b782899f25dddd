"""How a robot file is read as its author meant it, where PyBullet reads it differently."""

from __future__ import annotations

from dataclasses import dataclass

from carom.description import Inertial


@dataclass(frozen=True, slots=True)
class Written:
    """Choices of a reading that takes a file as written.

    Attributes:
        missing_meshes: Shapes whose mesh is missing, or of an unknown kind, are left out and reported;
            otherwise they are errors.
        xacro_args: Names and values of `<xacro:arg>` in a document of xacro.
        default_mass: Mass of links without `<inertial>` [kg], with as many kg m² about all axes; None for
            links without mass.
    """

    missing_meshes: bool = False
    default_mass: float | None = None
    xacro_args: tuple[tuple[str, str], ...] = ()

    def without_inertial(self) -> Inertial:
        """The inertial of a link that states none."""
        mass = self.default_mass or 0.0
        return Inertial(mass, tensor=(mass, 0.0, 0.0, mass, 0.0, mass))
