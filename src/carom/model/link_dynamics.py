"""The parameters of one link that users can read and change during the simulation."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields, replace
from math import inf
from operator import attrgetter
from typing import Any

from carom.description.link import ContactParameters
from carom.description.pose import Vector3
from carom.layouts.contacts import MARGIN
from carom.layouts.dynamics_parameters import OF_SHAPES
from carom.model.body_spec import LinkSpec
from carom.model.inertia import collision_margin

DEFAULT_FRICTION = 0.5
DEFAULT_LIMIT_IMPULSE = 100.0
DEFAULT_CONTACT_PROCESSING_THRESHOLD = 1e18
UNSET = -1.0


@dataclass(frozen=True, slots=True)
class ShapeSurface:
    """The surface of a shape that is not as its link's; attributes as those of `LinkDynamics`."""

    lateral_friction: float = DEFAULT_FRICTION
    rolling_friction: float = 0.0
    spinning_friction: float = 0.0
    restitution: float = 0.0
    contact_stiffness: float = UNSET
    contact_damping: float = UNSET
    friction_rank: int = 0
    friction_dimensions: int = 0
    contact_reference: tuple[float, float, float, float] = (0.0, 0.0, 0.0, 0.0)
    contact_impedance: tuple[float, float, float, float] = (0.0, 0.0, 0.0, 0.0)
    contact_mixing: tuple[float, float, float] = (0.0, 0.0, 0.0)
    surface_velocity: Vector3 = (0.0, 0.0, 0.0)
    surface_spin: Vector3 = (0.0, 0.0, 0.0)


DIMENSIONS_NEEDED = {"lateral_friction": 3, "spinning_friction": 4, "rolling_friction": 6}
"""How many dimensions a contact has in which a coefficient of friction counts."""
Surfaces = tuple[ShapeSurface | None, ...]
"""Of each collision shape of a link, its surface if that is not as the link's; empty if all are."""


@dataclass(slots=True)
class LinkDynamics:
    """Inertia, surface and joint limits of a link.

    Attributes:
        mass: [kg]; 0 for a fixed base.
        inertia: Principal moments [kg m²].
        lateral_friction: Coulomb coefficient.
        rolling_friction: [m].
        spinning_friction: [m].
        restitution: Coefficient of restitution.
        contact_stiffness: [N/m]; -1 if unset.
        contact_damping: [N s/m]; -1 if unset.
        friction_anchor: Whether friction has a position anchor.
        friction_rank: How friction is combined, see `carom.description.ContactParameters`.
        friction_dimensions: Which coefficients count in contacts, see there.
        contact_reference: Spring and damper of contacts that yield, see `carom.description.compliance`.
        contact_impedance: Their impedance and inverse mass; 0 for rigid ones.
        contact_mixing: How both are combined with those of another link.
        surface_velocity: Of the surface in the shape, along the axes of each shape [m/s].
        surface_spin: Its angular velocity there, about the origin of each shape [rad/s].
        collision_margin: [m].
        ccd_swept_sphere_radius: [m]; 0 switches continuous detection off.
        contact_processing_threshold: Maximum distance at which a contact is solved, of pairs whose bounds
            meet later [m].
        anisotropic_friction: Factors on friction along the link's axes.
        joint_damping: [N m s/rad or N s/m].
        joint_armature: Inertia of the drive, seen at the joint [kg m² or kg].
        joint_stiffness: Of the joint's spring [N m/rad or N/m].
        joint_spring_reference: Position coordinates at which this spring is at rest [rad or m].
        joint_lower_limit: [rad or m].
        joint_upper_limit: [rad or m]; there are no limits if it is less than the lower limit.
        joint_limit_impulse: Maximum impulse of a limit per substep [N m s or N s].
        surfaces: Of each collision shape, its surface if that is not as stated here; none if all are.
    """

    mass: float
    inertia: Vector3
    lateral_friction: float = DEFAULT_FRICTION
    rolling_friction: float = 0.0
    spinning_friction: float = 0.0
    restitution: float = 0.0
    contact_stiffness: float = UNSET
    contact_damping: float = UNSET
    friction_anchor: bool = False
    collision_margin: float = MARGIN
    ccd_swept_sphere_radius: float = 0.0
    contact_processing_threshold: float = DEFAULT_CONTACT_PROCESSING_THRESHOLD
    anisotropic_friction: Vector3 = (1.0, 1.0, 1.0)
    joint_damping: float = 0.0
    joint_lower_limit: float = 0.0
    joint_upper_limit: float = -1.0
    joint_limit_impulse: float = DEFAULT_LIMIT_IMPULSE
    joint_armature: float = 0.0
    joint_stiffness: float = 0.0
    joint_spring_reference: tuple[float, ...] = ()
    friction_rank: int = 0
    friction_dimensions: int = 0
    contact_reference: tuple[float, float, float, float] = (0.0, 0.0, 0.0, 0.0)
    contact_impedance: tuple[float, float, float, float] = (0.0, 0.0, 0.0, 0.0)
    contact_mixing: tuple[float, float, float] = (0.0, 0.0, 0.0)
    surface_velocity: Vector3 = (0.0, 0.0, 0.0)
    surface_spin: Vector3 = (0.0, 0.0, 0.0)
    surfaces: Surfaces = ()

    @classmethod
    def of(cls, link: LinkSpec) -> LinkDynamics:
        """The parameters of a link after loading."""
        contact = link.contact
        dynamics = cls(
            mass=link.mass,
            inertia=link.inertia,
            joint_damping=link.damping,
            joint_armature=link.armature,
            joint_stiffness=link.stiffness,
            joint_spring_reference=link.spring_rest,
            joint_lower_limit=link.lower,
            joint_upper_limit=link.upper,
            friction_anchor=contact.friction_anchor,
            collision_margin=collision_margin(link),
        )
        for name, value in _stated(contact).items():
            setattr(dynamics, name, value)
        if any(shape.contact not in (None, contact) for shape in link.collisions):
            dynamics.surfaces = tuple(
                None if shape.contact is None else ShapeSurface(**_stated(shape.contact))
                for shape in link.collisions
            )
        return dynamics

    def surface_of(self, shape: int) -> ShapeSurface:
        """The surface of one of the link's collision shapes, by its number among them."""
        own = self.surfaces[shape] if self.surfaces else None
        return ShapeSurface(**{name: getattr(self, name) for name in OF_SHAPES}) if own is None else own

    def surfaces_with(self, values: Mapping[str, Any]) -> Surfaces:
        """The surfaces of shapes after some parameters of the link were set, which then hold for all."""
        common = {name: value for name, value in values.items() if name in OF_SHAPES}
        return tuple(
            None if own is None else replace(own, **with_dimensions(own, common)) for own in self.surfaces
        )

    def copy(self) -> LinkDynamics:
        """An independent copy."""
        return LinkDynamics(*_values(self))


def _stated(contact: ContactParameters) -> dict[str, Any]:
    """What contact parameters state, by the names in `LinkDynamics`."""
    stated: dict[str, Any] = {
        "lateral_friction": contact.lateral_friction,
        "rolling_friction": contact.rolling_friction,
        "spinning_friction": contact.spinning_friction,
        "restitution": contact.restitution,
        "contact_stiffness": contact.stiffness,
        "contact_damping": contact.damping,
        "friction_rank": contact.friction_rank,
        "friction_dimensions": contact.friction_dimensions,
    }
    if (yielding := contact.compliance) is not None:
        stated["contact_reference"] = yielding.compliance.reference
        stated["contact_impedance"] = yielding.compliance.impedance
        stated["contact_mixing"] = yielding.mixing
    if contact.surface_motion is not None:
        x, y, z, turning_x, turning_y, turning_z = contact.surface_motion
        stated["surface_velocity"] = (x, y, z)
        stated["surface_spin"] = (turning_x, turning_y, turning_z)
    return {name: value for name, value in stated.items() if value is not None}


def with_dimensions(surface: LinkDynamics | ShapeSurface, changes: Mapping[str, Any]) -> Mapping[str, Any]:
    """Changes of a surface, and of its dimensions where they are too few for a coefficient that is set."""
    present = surface.friction_dimensions
    if not present or "friction_dimensions" in changes:
        return changes
    needed = [needed for name, needed in DIMENSIONS_NEEDED.items() if changes.get(name, 0.0) > 0.0]
    return {**changes, "friction_dimensions": max(needed)} if needed and max(needed) > present else changes


_values = attrgetter(*(field.name for field in fields(LinkDynamics)))


def enforced_limits(spec: LinkSpec, dynamics: LinkDynamics) -> tuple[float, float]:
    """Minimum and maximum position of a link's joint that are enforced; -inf and inf without a limit."""
    lower, upper = dynamics.joint_lower_limit, dynamics.joint_upper_limit
    # Some limits of a file are ignored, those of a continuous joint for example.
    only_stated = not spec.limited and (lower, upper) == (spec.lower, spec.upper)
    return (-inf, inf) if only_stated or lower > upper else (lower, upper)
