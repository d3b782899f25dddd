"""Moments of inertia that links get with another mass, and the margins that these depend on."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from carom.layouts.flags import LoadFlags
from carom.model.inertia import collision_margin, margin_is_radius, mass_terms, moments_at

if TYPE_CHECKING:
    from carom.description.pose import Vector3
    from carom.description.shapes.moments import MassTerms
    from carom.scene.dynamics.places import Parts


def scaled_inertia(body: Parts, link: int, mass: float) -> Vector3:
    """Principal moments of inertia [kg m²] of a link whose mass changes and whose shape and density do not.

    Args:
        body: The body.
        link: The link; -1 is the base.
        mass: The new mass [kg].

    Returns:
        The present moments, in proportion to the mass; those of the file if the link has no mass now, as a
        fixed base; those of the collision shapes if the file states no mass either.
    """
    unit = unit_inertia(body, link)
    if unit is None:
        return shape_inertia(body, link, mass)
    x, y, z = unit
    return (x * mass, y * mass, z * mass)


def unit_inertia(body: Parts, link: int) -> Vector3 | None:
    """The moments of `scaled_inertia` at 1 kg [m²]; None if those of the collision shapes are asked for."""
    for known in (body.dynamics(link), body.link_spec(link)):
        if known.mass > 0.0:
            x, y, z = known.inertia
            return (x / known.mass, y / known.mass, z / known.mass)
    return None


def shape_inertia(body: Parts, link: int, mass: float) -> Vector3:
    """Principal moments of inertia [kg m²] of a link's collision shapes for a given mass [kg]."""
    return moments_at(mass, shape_terms(body, link))


def shape_terms(body: Parts, link: int) -> MassTerms:
    """The principal moments of inertia of a link's collision shapes as a function of the mass.

    The margin that `collision_margin` has set widens the box that several shapes, or a hull, count as.
    """
    implicit = bool(body.spec.flags & LoadFlags.USE_IMPLICIT_CYLINDER)
    spec = body.link_spec(link)
    margin = body.dynamics(link).collision_margin
    if margin == collision_margin(spec):
        return mass_terms(spec, implicit_cylinder=implicit)
    return mass_terms(replace(spec, compound_margin=margin), implicit_cylinder=implicit, margin=margin)


def has_margin(body: Parts, link: int) -> bool:
    """Whether a link's margin can change: that of a ball or a capsule is its radius, as in Bullet."""
    return not margin_is_radius(body.link_spec(link))
