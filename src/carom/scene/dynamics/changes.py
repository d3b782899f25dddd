"""Changing inertia, surface, limits and presence of a body during the simulation."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import fields, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from carom.engine.presence import change_presence
from carom.layouts.dynamics_parameters import (
    BODY,
    FRICTION,
    JOINT_TERMS,
    LIMITS,
    LINK,
    PARAMETERS,
    POSITION,
    SHAPE,
    SURFACE_FIELDS,
    Parameter,
)
from carom.layouts.flags import ActivationChange
from carom.model.body_spec import BASE
from carom.model.link_dynamics import with_dimensions
from carom.native.change import Change
from carom.native.gates import gated
from carom.native.uninterrupted import uninterrupted
from carom.scene.dynamics.inertia import scaled_inertia
from carom.scene.dynamics.places import note
from carom.scene.joint_terms.implicit import DAMPING, checked_terms, note_terms, write_terms

if TYPE_CHECKING:
    from carom.description.pose import Vector3
    from carom.model.link_dynamics import LinkDynamics
    from carom.scene.core.body_core import BodyCore


_ACTIVATION, _MASS, _INERTIA = "activation_state", "mass", "inertia"
_OF_LIMITS = {*LIMITS, "joint_limit_force"}


@gated("world.call_lock")
def change_dynamics(body: BodyCore, link: int, changes: Mapping[str, Any]) -> None:
    """Change parameters of a link, its joint or the whole body: either all changes are made or none."""
    with uninterrupted:
        body.world.refuse_in_step()
        change = Change()
        note_dynamics(change, body, link, changes)
        change.commit()


@gated("world.call_lock")
def change_limits(body: BodyCore, limits: Mapping[int, tuple[float, float]]) -> None:
    """Change the limits of several joints: either all or none."""
    with uninterrupted:
        body.world.refuse_in_step()
        change = Change()
        # Those that end come first.
        for joint, (lower, upper) in sorted(limits.items(), key=lambda it: it[1][0] <= it[1][1]):
            note_dynamics(change, body, joint, {"joint_lower_limit": lower, "joint_upper_limit": upper})
        change.commit()


def note_dynamics(change: Change, body: BodyCore, link: int, changes: Mapping[str, Any]) -> None:
    """Note a change of the dynamics of a link.

    Raises:
        AttributeError: There is no such parameter.
        TypeError, ValueError: A value is not a number, or not three numbers for a vector.
    """
    surface: dict[str, Any] = {}
    others: dict[str, Any] = {}
    for name, value in changes.items():
        known = _checked(name, value)
        (surface if known.owner == SHAPE else others)[name] = value
    renews = bool(others) and _note_others(change, body, link, others)
    if surface:
        dynamics = body.dynamics(link)
        shapes = body.world.contact_arrays.shapes
        written = with_dimensions(dynamics, surface)
        for name, value in written.items():
            change.set(dynamics, name, value)
        if dynamics.surfaces:
            change.set(dynamics, "surfaces", dynamics.surfaces_with(written))
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


def _checked(name: str, value: Any) -> Parameter:
    """A parameter; checks that it exists and that a value has its type, before anything is changed."""
    known = PARAMETERS.get(name)
    if known is None or known.owner == FRICTION:
        there = ", ".join(name for name, known in PARAMETERS.items() if known.owner != FRICTION)
        raise AttributeError(f"links have no parameter {name!r}; those that can be changed are {there}")
    if known.kind == "3":
        x, y, z = value
        for component in (x, y, z):
            _check_number(component)
    elif known.owner == POSITION and hasattr(value, "__len__"):
        for component in value:
            _check_number(component)
    elif type(value) is not float:
        _check_number(value)
    return known


def _check_number(value: Any) -> None:
    # `float` also takes text.
    if isinstance(value, (str, bytes, bytearray)):
        raise TypeError(f"must be a real number, not {value!r}")
    float(value)


def _note_others(change: Change, body: BodyCore, link: int, changes: Mapping[str, Any]) -> bool:
    """Note all changes except those of contact parameters; whether what is derived from the scene changes."""
    renews = of_joint = False
    for name, value in changes.items():
        known = PARAMETERS[name]
        if known.owner not in (BODY, LINK):
            of_joint = True
        elif known.owner == BODY and name != _ACTIVATION:
            note(change, body.world, body, link, name, value)
    if _ACTIVATION in changes:
        _note_activation(change, body, ActivationChange(changes[_ACTIVATION]))
        renews = True
    if _MASS in changes:
        renews |= _note_mass(change, body, link, changes[_MASS], changes.get(_INERTIA))
    elif _INERTIA in changes:
        change.set(body.dynamics(link), _INERTIA, changes[_INERTIA])
        _note_inertia(change, body, link)
    if of_joint and link != BASE:
        renews |= _note_joint(change, body, link, changes)
    elif of_joint:
        _note_of_base(change, body, changes)
    return renews


def _note_of_base(change: Change, body: BodyCore, changes: Mapping[str, Any]) -> None:
    """Note what files of a base state about the joint that it lacks, which then does nothing."""
    own = [name for name in JOINT_TERMS if name in changes and name != DAMPING]
    if own:
        raise ValueError(f"the base has no joint, and no {own[0]}")
    for name in (DAMPING, *LIMITS):
        if name in changes:
            change.set(body.dynamics(BASE), name, changes[name])


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
    if changes.keys().isdisjoint(_OF_LIMITS):
        return False
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
    note(change, body.world, body, link, _MASS, dynamics.mass)
    note(change, body.world, body, link, _INERTIA, dynamics.inertia)
    if link != BASE:
        write_terms(change, body, link, dynamics)
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


def _note_inertia(change: Change, body: BodyCore, link: int) -> None:
    dynamics = body.dynamics(link)
    mass, inertia = (change.get(dynamics, name) for name in ("mass", "inertia"))
    change.set(body, "derived", {})
    note(change, body.world, body, link, _MASS, mass)
    note(change, body.world, body, link, _INERTIA, inertia)


@gated("world.call_lock")
def set_present(body: BodyCore, present: bool) -> None:
    """Let a body come or go, or leave it as it is; see `Body.present`."""
    world = body.world
    with uninterrupted:
        wanted, only = np.array([present]), np.zeros(1, dtype=np.int64)
        change = Change()
        change_presence(world.arrays, world.contact_arrays, body.rows, only, wanted, change)
        world.change_scene(change)
        change.commit()
