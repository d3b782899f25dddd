"""Changing inertia, surface, limits and presence of a body during the simulation."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import fields, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from carom.engine.presence import change_presence
from carom.layouts.flags import ActivationChange, LoadFlags
from carom.layouts.quick_world import OF_BODY
from carom.model.body_spec import BASE
from carom.model.inertia import collision_margin, margin_is_radius, mass_terms, moments_at
from carom.model.link_dynamics import with_dimensions
from carom.model.shape_arrays import SURFACE_FIELDS
from carom.native.change import Change
from carom.native.gates import alone
from carom.native.uninterrupted import uninterrupted
from carom.scene.joint_terms.implicit import (
    OF_DOFS,
    SPRING_REFERENCE,
    checked_terms,
    note_all_terms,
    note_terms,
)

if TYPE_CHECKING:
    from carom.description.pose import Vector3
    from carom.model.inertia import MassTerms
    from carom.model.link_dynamics import LinkDynamics
    from carom.scene.core.body_core import BodyCore


_SLEEP_THRESHOLD = "sleep_threshold"
_ACTIVATION = "activation_state"
_OF_JOINT = ("joint_damping", "joint_lower_limit", "joint_upper_limit")
_ONLY_OF_JOINT = (*OF_DOFS, SPRING_REFERENCE)
_VECTORS = ("inertia", "anisotropic_friction", "surface_velocity", "surface_spin")
_NOT_OF_SURFACE = {
    *OF_BODY,
    _SLEEP_THRESHOLD,
    _ACTIVATION,
    *_OF_JOINT,
    *_ONLY_OF_JOINT,
    "mass",
    "inertia",
    "joint_limit_force",
}


@alone("world.call_lock")
def change_dynamics(body: BodyCore, link: int, changes: Mapping[str, Any]) -> None:
    """Change parameters of a link, its joint or the whole body: either all changes are made or none."""
    with uninterrupted:
        body.world.refuse_in_step()
        change = Change()
        note_dynamics(change, body, link, changes)
        change.commit()


def note_dynamics(change: Change, body: BodyCore, link: int, changes: Mapping[str, Any]) -> None:
    """Note a change of the dynamics of a link.

    Raises:
        AttributeError: There is no such parameter.
        TypeError, ValueError: A value is not a number, or not three numbers for a vector.
    """
    dynamics = body.dynamics(link)
    for name, value in changes.items():
        _check(dynamics, name, value)
    is_other = not changes.keys().isdisjoint(_NOT_OF_SURFACE)
    renews = is_other and _note_others(change, body, link, changes)
    surface = changes
    if is_other:
        surface = {name: value for name, value in changes.items() if name not in _NOT_OF_SURFACE}
    if surface:
        surface = with_dimensions(dynamics, surface)
        shapes = body.world.contact_arrays.shapes
        for name, value in surface.items():
            change.set(dynamics, name, value)
        if dynamics.surfaces:
            change.set(dynamics, "surfaces", dynamics.surfaces_with(surface))
        written = {name: value for name, value in surface.items() if name in SURFACE_FIELDS}
        shapes.note_surface(change, body.first_link + 1 + link, written)
        renews = renews or (not shapes.looks_ahead and surface.get("ccd_swept_sphere_radius", 0.0) > 0.0)
    if renews:
        body.world.change_scene(change)


def note_surface_of_shape(
    change: Change, body: BodyCore, link: int, shape: int, changes: Mapping[str, Any]
) -> None:
    """Note a change of the surface of one of a link's several shapes, by its number among them."""
    dynamics = body.dynamics(link)
    present = dynamics.surfaces or (None,) * len(body.link_spec(link).collisions)
    present_surface = dynamics.surface_of(shape)
    own = replace(present_surface, **with_dimensions(present_surface, changes))
    surfaces = (*present[:shape], own, *present[shape + 1 :])
    change.set(dynamics, "surfaces", surfaces)
    body.world.contact_arrays.shapes.note_own_surfaces(change, body.first_link + 1 + link, surfaces)


def _check(dynamics: LinkDynamics, name: str, value: Any) -> None:
    """Check that a parameter exists and has a value of the right type, before anything is changed."""
    if name in _VECTORS:
        x, y, z = value
        for component in (x, y, z):
            _check_number(component)
    elif name == SPRING_REFERENCE and hasattr(value, "__len__"):
        for component in value:
            _check_number(component)
    elif type(value) is not float:
        _check_number(value)
    if name not in _NOT_OF_SURFACE:
        getattr(dynamics, name)


def _check_number(value: Any) -> None:
    # `float` also takes text.
    if isinstance(value, (str, bytes, bytearray)):
        raise TypeError(f"must be a real number, not {value!r}")
    float(value)


def _note_others(change: Change, body: BodyCore, link: int, changes: Mapping[str, Any]) -> bool:
    """Note all changes except those of contact parameters; whether what is derived from the scene changes."""
    model, tree = body.world.arrays.model.numpy, body.rows.tree
    renews = False
    for name, field in OF_BODY.items():
        if name in changes:
            change.write(model[field][:, tree], changes[name])
    if _SLEEP_THRESHOLD in changes:
        change.write(model["tree_sleep_threshold"][tree : tree + 1], changes[_SLEEP_THRESHOLD])
    if _ACTIVATION in changes:
        _note_activation(change, body, ActivationChange(changes[_ACTIVATION]))
        renews = True
    if "mass" in changes:
        renews |= _note_mass(change, body, link, changes["mass"], changes.get("inertia"))
    elif "inertia" in changes:
        change.set(body.dynamics(link), "inertia", changes["inertia"])
        _note_inertia(change, body, link)
    if link != BASE:
        renews |= _note_joint(change, body, link, changes)
    elif own := [name for name in _ONLY_OF_JOINT if name in changes]:
        raise ValueError(f"the base has no joint, and no {own[0]}")
    else:
        for name in changes.keys() & _OF_JOINT:
            change.set(body.dynamics(link), name, changes[name])
    return renews


def _note_activation(change: Change, body: BodyCore, wanted: ActivationChange) -> None:
    """Put a body to sleep, wake it up, or change whether it may fall asleep by itself.

    As in Bullet, this takes effect at the end of the next step, and whether a body may fall asleep cannot be
    changed while the body may not wake up.
    """
    model, state = body.world.arrays.model.numpy, body.world.arrays.state.numpy
    tree = body.rows.tree
    one = slice(tree, tree + 1)
    can_sleep, can_wake = bool(model["tree_can_sleep"][tree]), bool(model["tree_can_wake"][tree])
    if can_wake:
        can_sleep = can_sleep or bool(wanted & ActivationChange.ENABLE_SLEEPING)
        can_sleep = can_sleep and not wanted & ActivationChange.DISABLE_SLEEPING
    can_wake = can_wake or bool(wanted & ActivationChange.ENABLE_WAKEUP)
    can_wake = can_wake and not wanted & ActivationChange.DISABLE_WAKEUP
    if wanted & ActivationChange.WAKE_UP:
        change.write(state["tree_wants_sleep"][0, one], False)
        change.write(state["tree_idle_time"][0, one], 0.0)
    if wanted & ActivationChange.SLEEP:
        change.write(state["tree_wants_sleep"][0, one], True)
    change.write(model["tree_can_sleep"][one], can_sleep)
    change.write(model["tree_can_wake"][one], can_wake)


def _note_joint(change: Change, body: BodyCore, joint: int, changes: Mapping[str, Any]) -> bool:
    """Note changes of a joint's terms and limits; whether what is derived from the scene changes."""
    world, dynamics = body.world, body.dynamics(joint)
    terms = checked_terms(body, joint, changes)
    if terms:
        note_terms(change, body, joint, terms)
    limit = world.joint_constraints.limit_of(body, joint)
    renews = False
    if "joint_lower_limit" in changes or "joint_upper_limit" in changes:
        lower = changes.get("joint_lower_limit", dynamics.joint_lower_limit)
        upper = changes.get("joint_upper_limit", dynamics.joint_upper_limit)
        if lower > upper:
            lower, upper = 1.0, -1.0
        change.set(dynamics, "joint_lower_limit", lower)
        change.set(dynamics, "joint_upper_limit", upper)
        if body.velocity_count[joint] == 1:
            limit = world.joint_constraints.set_limit(change, body, joint, lower, upper)
            renews = True
    if "joint_limit_force" in changes and limit is not None:
        # The maximum impulse of a limit: the force times the present duration of a substep.
        impulse = changes["joint_limit_force"] * world.parameters.substep_time
        change.set(limit, "max_impulse", impulse)
        change.set(dynamics, "joint_limit_impulse", impulse)
        renews = True
    return renews


def set_dynamics(body: BodyCore, link: int, dynamics: LinkDynamics) -> None:
    """Set all parameters of a link, except the limits of its joint, at once; see `Body.set_dynamics`."""
    with uninterrupted:
        body.world.refuse_in_step()
        _set_dynamics(body, link, dynamics)


def _set_dynamics(body: BodyCore, link: int, dynamics: LinkDynamics) -> None:
    change, row = Change(), body.first_link + 1 + link
    world, present = body.world, body.dynamics(link)
    for field in fields(dynamics):
        change.set(present, field.name, getattr(dynamics, field.name))
    change.set(body, "derived", {})
    world.arrays.note_inertia(change, row, dynamics.mass, dynamics.inertia)
    if link != BASE:
        note_all_terms(change, body, link, dynamics)
    surface = {name: getattr(dynamics, name) for name in SURFACE_FIELDS}
    if surface["collision_margin"] == present.collision_margin:
        del surface["collision_margin"]
    world.contact_arrays.shapes.note_surface(change, row, surface)
    world.contact_arrays.shapes.note_own_surfaces(change, row, dynamics.surfaces)
    change.commit()


def _note_mass(change: Change, body: BodyCore, link: int, mass: float, inertia: Vector3 | None) -> bool:
    """Note mass and inertia (by default scaled with the mass); whether the base is freed or fixed by it."""
    world, dynamics = body.world, body.dynamics(link)
    change.set(dynamics, "inertia", scaled_inertia(body, link, mass) if inertia is None else inertia)
    change.set(dynamics, "mass", mass)
    _note_inertia(change, body, link)
    frees_or_fixes = link == BASE and (mass > 0.0) == body.fixed_base
    if frees_or_fixes:
        world.contact_arrays.part(change, [body.first_link])
        change_base_freedom(change, body, free=mass > 0.0)
        world.contact_arrays.shapes.note_default_group(change, body.first_link, fixed=mass == 0.0)
    return frees_or_fixes


def change_base_freedom(change: Change, body: BodyCore, *, free: bool) -> None:
    """Free the base of a body, or fix it in the world, with a change."""
    world = body.world
    world.arrays.set_base_freedom(body.rows, free=free, change=change)
    change.set(body, "fixed_base", not free)
    change.set(body, "derived", {})
    world.joint_constraints.free_base(change, body, free=free)


def scaled_inertia(body: BodyCore, link: int, mass: float) -> Vector3:
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


def unit_inertia(body: BodyCore, link: int) -> Vector3 | None:
    """The moments of `scaled_inertia` at 1 kg [m²]; None if those of the collision shapes are asked for."""
    for known in (body.dynamics(link), body.link_spec(link)):
        if known.mass > 0.0:
            x, y, z = known.inertia
            return (x / known.mass, y / known.mass, z / known.mass)
    return None


def shape_inertia(body: BodyCore, link: int, mass: float) -> Vector3:
    """Principal moments of inertia [kg m²] of a link's collision shapes for a given mass [kg]."""
    return moments_at(mass, shape_terms(body, link))


def shape_terms(body: BodyCore, link: int) -> MassTerms:
    """The principal moments of inertia of a link's collision shapes as a function of the mass.

    The margin that `collision_margin` has set widens the box that several shapes, or a hull, count as.
    """
    implicit = bool(body.spec.flags & LoadFlags.USE_IMPLICIT_CYLINDER)
    spec = body.link_spec(link)
    margin = body.dynamics(link).collision_margin
    if margin == collision_margin(spec):
        return mass_terms(spec, implicit_cylinder=implicit)
    return mass_terms(replace(spec, compound_margin=margin), implicit_cylinder=implicit, margin=margin)


def has_margin(body: BodyCore, link: int) -> bool:
    """Whether a link's margin can change: that of a ball or a capsule is its radius, as in Bullet."""
    return not margin_is_radius(body.link_spec(link))


def _note_inertia(change: Change, body: BodyCore, link: int) -> None:
    dynamics = body.dynamics(link)
    mass, inertia = (change.get(dynamics, name) for name in ("mass", "inertia"))
    change.set(body, "derived", {})
    body.world.arrays.note_inertia(change, body.first_link + 1 + link, mass, inertia)


@alone("world.call_lock")
def set_present(body: BodyCore, present: bool) -> None:
    """Let a body come or go, or leave it as it is; see `Body.present`."""
    world = body.world
    with uninterrupted:
        wanted, only = np.array([present]), np.zeros(1, dtype=np.int64)
        change = Change()
        change_presence(world.arrays, world.contact_arrays, body.rows, only, wanted, change)
        world.change_scene(change)
        change.commit()
