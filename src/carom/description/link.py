"""A rigid link: its inertia, its shapes and its contact parameters."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING

from carom.description.geometry import Geometry
from carom.description.pose import IDENTITY, Pose

if TYPE_CHECKING:
    from carom.description.compliance import ContactCompliance
    from carom.description.fluid import FluidEllipsoid
    from carom.description.texture import Texture

Rgba = tuple[float, float, float, float]


@dataclass(frozen=True, slots=True)
class Inertial:
    """Mass and rotational inertia about the centre of mass.

    Attributes:
        mass: [kg].
        frame: Inertial frame in the link frame; its origin is the centre of mass.
        tensor: (ixx, ixy, ixz, iyy, iyz, izz) [kg m²] in the inertial frame.
    """

    mass: float = 1.0
    frame: Pose = IDENTITY
    tensor: tuple[float, float, float, float, float, float] = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0)


@dataclass(frozen=True, slots=True)
class Material:
    """Appearance of a visual shape: colour, specular colour, and texture file or image.

    `reflectance` is the share of light that a plane mirrors, from 0 to 1.
    """

    name: str = ""
    rgba: Rgba | None = None
    specular: tuple[float, float, float] | None = None
    texture: Path | None = None
    image: Texture | None = None
    reflectance: float = 0.0


@dataclass(frozen=True, slots=True)
class Collision:
    """A collision shape; `frame` is its pose in the link frame.

    Attributes:
        ends_frame: For a capsule or cylinder whose ends the file states: the frame in which it states them,
            in the link frame. PyBullet computes a different inertia for such shapes.
        implicit: Whether a capsule given by its ends is a compound of a capsule in PyBullet, and not `swept`.
        contact: How it touches others; None as its link does.
    """

    geometry: Geometry
    frame: Pose = IDENTITY
    name: str = ""
    group: int | None = None
    mask: int | None = None
    ends_frame: Pose | None = None
    implicit: bool = False
    contact: ContactParameters | None = None

    @property
    def swept(self) -> bool:
        """Whether the shape is a swept sphere in PyBullet."""
        return self.ends_frame is not None and self.geometry.sweeps and not self.implicit


@dataclass(frozen=True, slots=True)
class Visual:
    """A visual shape; `frame` is its pose in the link frame.

    It `stands_in` for the visual shapes of a link that has none if it was made from a collision shape.
    `group` is the number of its group, which windows show or hide; None in files that have no groups.
    """

    geometry: Geometry
    frame: Pose = IDENTITY
    name: str = ""
    material: Material | None = None
    user_data: dict[str, str] = field(default_factory=dict)
    stands_in: bool = False
    group: int | None = None


@dataclass(frozen=True, slots=True)
class ContactParameters:
    """Contact parameters of a link; None means the engine's default.

    Attributes:
        lateral_friction: Coulomb coefficient.
        rolling_friction: Torque per normal force about the tangents [m].
        spinning_friction: Torque per normal force about the normal [m].
        restitution: Coefficient of restitution.
        stiffness: Contact spring [N/m].
        damping: Contact damper [N s/m].
        inertia_scaling: Factor on the link's inertia.
        friction_anchor: Keep a position anchor for friction.
        friction_rank: How friction is combined with that of another link, if both have a rank: the higher one
            decides, and of equal ones the greater coefficients. 0 is none; then coefficients are multiplied.
        friction_dimensions: Of a link with a rank, how many directions its contacts have, as `condim` of MJCF
            files: 1 without friction, 3 with lateral friction, 4 with spinning, 6 with rolling friction as
            well. They are combined as coefficients are, and say which of these count. 0 if not stated: then
            as many as there are coefficients.
        compliance: How contacts yield; None for rigid ones, or those of `stiffness` and `damping`.
        surface_motion: How the surface moves in the shape, as that of a belt: velocity [m/s] and angular
            velocity [rad/s] along the axes of the shape, about its origin; None if it doesn't.
    """

    lateral_friction: float | None = None
    rolling_friction: float | None = None
    spinning_friction: float | None = None
    restitution: float | None = None
    stiffness: float | None = None
    damping: float | None = None
    inertia_scaling: float | None = None
    friction_anchor: bool = False
    friction_rank: int = 0
    friction_dimensions: int = 0
    compliance: ContactCompliance | None = None
    surface_motion: tuple[float, float, float, float, float, float] | None = None

    def without_rank(self) -> ContactParameters:
        """What it is beside links without a rank, without one: only coefficients that count are kept."""
        if not self.friction_dimensions:
            return replace(self, friction_rank=0)
        return replace(
            self,
            friction_rank=0,
            friction_dimensions=0,
            lateral_friction=self.lateral_friction if self.friction_dimensions > 1 else 0.0,
            spinning_friction=self.spinning_friction if self.friction_dimensions > 3 else None,
            rolling_friction=self.rolling_friction if self.friction_dimensions > 4 else None,
        )


@dataclass(frozen=True, slots=True)
class Link:
    """One rigid body of a robot.

    Attributes:
        gravity_compensation: Share of its weight that a force at its centre of mass carries; 1 for all.
        fluid: What feels the fluid of the world instead of the box of its inertia.
    """

    name: str
    inertial: Inertial = Inertial()
    collisions: tuple[Collision, ...] = ()
    visuals: tuple[Visual, ...] = ()
    contact: ContactParameters = ContactParameters()
    gravity_compensation: float = 0.0
    fluid: FluidEllipsoid | None = None
    user_data: dict[str, str] = field(default_factory=dict)
