"""Changing inertia, surface, limits and presence of a body during the simulation."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from carom.engine.presence import change_presence
from carom.layouts.flags import ActivationChange, LoadFlags
from carom.layouts.quick_world import DAMPING
from carom.model.body_spec import BASE
from carom.model.inertia import collision_margin, margin_is_radius, mass_terms, moments_at
from carom.native.uninterrupted import uninterrupted
from carom.scene.joint_terms.implicit import OF_DOFS, SPRING_REFERENCE, checked_terms, set_terms, write_terms

if TYPE_CHECKING:
    from carom.description.pose import Vector3
    from carom.model.inertia import MassTerms
    from carom.scene.body import Body
    from carom.scene.link_dynamics import LinkDynamics
    from carom.world.world import World


OF_BODY = {**DAMPING, "max_joint_velocity": "tree_max_velocity"}
_SLEEP_THRESHOLD = "sleep_threshold"
_ACTIVATION = "activation_state"
_OF_JOINT = ("joint_damping", "joint_lower_limit", "joint_upper_limit")
_ONLY_OF_JOINT = (*OF_DOFS, SPRING_REFERENCE)
_VECTORS = ("inertia", "anisotropic_friction")
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


def change_dynamics(body: Body, link: int, changes: Mapping[str, Any]) -> None:
    """Change parameters of a link, its joint or the whole body: either all changes are made or none."""
    undo = body.world.undo
    with uninterrupted:
        undo.settle()
        undo.at_once(dynamics_change(body, link, changes))


def dynamics_change(body: Body, link: int, changes: Mapping[str, Any]) -> Callable[[], None]:
    """Prepare a change of the dynamics of a link.

    Returns:
        A function that makes the change; if interrupted, it can be called again, with the same result.

    Raises:
        AttributeError: There is no such parameter.
        TypeError, ValueError: A value is not a number, or not three numbers for a vector.
    """
    dynamics = body.dynamics(link)
    for name, value in changes.items():
        _check(dynamics, name, value)
    if changes.keys().isdisjoint(_NOT_OF_SURFACE):
        return _surface_change(body, link, changes)
    steps = _other_changes(body, link, changes)
    surface = {name: value for name, value in changes.items() if name not in _NOT_OF_SURFACE}
    if surface:
        steps.append(_surface_change(body, link, surface))

    def change() -> None:
        for step in steps:
            step()

    return change


def _surface_change(body: Body, link: int, changes: Mapping[str, Any]) -> Callable[[], None]:
    """Prepare changes of contact parameters of a link."""
    shapes = body.world.contact_arrays.shapes
    will_look_ahead = not shapes.looks_ahead and changes.get("ccd_swept_sphere_radius", 0.0) > 0.0
    return partial(_change_surface, body, link, changes, will_look_ahead)


def _change_surface(body: Body, link: int, changes: Mapping[str, Any], will_look_ahead: bool) -> None:
    dynamics = body.dynamics(link)
    for name, value in changes.items():
        setattr(dynamics, name, value)
    body.world.contact_arrays.shapes.write_surface(body.first_link + 1 + link, dynamics, changes)
    if will_look_ahead:
        body.world.scene_changed()


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


def _other_changes(body: Body, link: int, changes: Mapping[str, Any]) -> list[Callable[[], None]]:
    """Prepare all changes except those of contact parameters; each function can be called again."""
    steps: list[Callable[[], None]] = []
    model, tree = body.world.arrays.model.numpy, body.rows.tree
    for name, field in OF_BODY.items():
        if name in changes:
            steps.append(partial(model[field][:, tree].fill, changes[name]))
    if _SLEEP_THRESHOLD in changes:
        steps.append(partial(model["tree_sleep_threshold"].__setitem__, tree, changes[_SLEEP_THRESHOLD]))
    if _ACTIVATION in changes:
        steps.append(_activation_change(body, ActivationChange(changes[_ACTIVATION])))
    if "mass" in changes:
        steps.append(_mass_change(body, link, changes["mass"], changes.get("inertia")))
    elif "inertia" in changes:
        steps.append(partial(_set_inertia, body, link, changes["inertia"]))
    if link != BASE:
        steps += _joint_changes(body, link, changes)
    elif own := [name for name in _ONLY_OF_JOINT if name in changes]:
        raise ValueError(f"the base has no joint, and no {own[0]}")
    else:
        dynamics = body.dynamics(link)
        steps += [partial(setattr, dynamics, name, changes[name]) for name in changes.keys() & _OF_JOINT]
    if "joint_limit_force" in changes:
        steps.append(partial(_set_limit_force, body, link, changes["joint_limit_force"]))
    return steps


def _activation_change(body: Body, change: ActivationChange) -> Callable[[], None]:
    """Prepare to put a body to sleep, wake it up, or change whether it may fall asleep by itself.

    As in Bullet, this takes effect at the end of the next step, and whether a body may fall asleep cannot be
    changed while the body may not wake up.
    """
    model, state = body.world.arrays.model.numpy, body.world.arrays.state.numpy
    tree = body.rows.tree
    can_sleep, can_wake = bool(model["tree_can_sleep"][tree]), bool(model["tree_can_wake"][tree])
    if can_wake:
        can_sleep = can_sleep or bool(change & ActivationChange.ENABLE_SLEEPING)
        can_sleep = can_sleep and not change & ActivationChange.DISABLE_SLEEPING
    can_wake = can_wake or bool(change & ActivationChange.ENABLE_WAKEUP)
    can_wake = can_wake and not change & ActivationChange.DISABLE_WAKEUP

    def set_activation() -> None:
        if change & ActivationChange.WAKE_UP:
            state["tree_wants_sleep"][0, tree], state["tree_idle_time"][0, tree] = False, 0.0
        if change & ActivationChange.SLEEP:
            state["tree_wants_sleep"][0, tree] = True
        model["tree_can_sleep"][tree], model["tree_can_wake"][tree] = can_sleep, can_wake
        body.world.scene_changed()

    return set_activation


def _joint_changes(body: Body, joint: int, changes: Mapping[str, Any]) -> Iterator[Callable[[], None]]:
    dynamics = body.dynamics(joint)
    terms = checked_terms(body, joint, changes)
    if terms:
        yield partial(set_terms, body, joint, terms)
    if "joint_lower_limit" in changes or "joint_upper_limit" in changes:
        lower = changes.get("joint_lower_limit", dynamics.joint_lower_limit)
        upper = changes.get("joint_upper_limit", dynamics.joint_upper_limit)
        yield partial(_set_limits, body, joint, lower, upper)


def write_link(body: Body, link: int) -> None:
    """Write `Body.dynamics` of a link to the engine, except the limits of its joint."""
    dynamics = body.dynamics(link)
    _write(body, link)
    if link != BASE:
        write_terms(body, link)
    body.world.contact_arrays.shapes.write_surface(body.first_link + 1 + link, dynamics)


def _mass_change(body: Body, link: int, mass: float, inertia: Vector3 | None) -> Callable[[], None]:
    """Prepare to set mass and inertia (by default scaled with the mass); mass 0 fixes a base."""
    world, dynamics = body.world, body.dynamics(link)
    moments = scaled_inertia(body, link, mass) if inertia is None else inertia
    frees_or_fixes = link == BASE and (mass > 0.0) == body.fixed_base
    part = world.contact_arrays.parting([body.first_link]) if frees_or_fixes else None

    def set_mass() -> None:
        dynamics.mass, dynamics.inertia = mass, moments
        _write(body, link)
        if part is not None:
            part()
            change_base_freedom(world, body, free=mass > 0.0)
            world.contact_arrays.shapes.set_default_group(body.first_link, fixed=mass == 0.0)
            world.scene_changed()

    return set_mass


def change_base_freedom(world: World, body: Body, *, free: bool) -> None:
    """Free the base of a body, or fix it in the world, within a change; can be called again."""
    set_base_freedom(world, body, free=free)
    world.constraints.base_freedom_changed(body)


def set_base_freedom(world: World, body: Body, *, free: bool) -> None:
    """Free the base of a body, or fix it in the world, without renumbering the islands."""
    world.arrays.set_base_freedom(body.rows, free=free)
    body.fixed_base = not free
    body.derived.clear()


def scaled_inertia(body: Body, link: int, mass: float) -> Vector3:
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


def unit_inertia(body: Body, link: int) -> Vector3 | None:
    """The moments of `scaled_inertia` at 1 kg [m²]; None if those of the collision shapes are asked for."""
    for known in (body.dynamics(link), body.link_spec(link)):
        if known.mass > 0.0:
            x, y, z = known.inertia
            return (x / known.mass, y / known.mass, z / known.mass)
    return None


def shape_inertia(body: Body, link: int, mass: float) -> Vector3:
    """Principal moments of inertia [kg m²] of a link's collision shapes for a given mass [kg]."""
    return moments_at(mass, shape_terms(body, link))


def shape_terms(body: Body, link: int) -> MassTerms:
    """The principal moments of inertia of a link's collision shapes as a function of the mass.

    The margin that `collision_margin` has set widens the box that several shapes, or a hull, count as.
    """
    implicit = bool(body.spec.flags & LoadFlags.USE_IMPLICIT_CYLINDER)
    spec = body.link_spec(link)
    margin = body.dynamics(link).collision_margin
    if margin == collision_margin(spec):
        return mass_terms(spec, implicit_cylinder=implicit)
    return mass_terms(replace(spec, compound_margin=margin), implicit_cylinder=implicit, margin=margin)


def has_margin(body: Body, link: int) -> bool:
    """Whether a link's margin can change: that of a ball or a capsule is its radius, as in Bullet."""
    return not margin_is_radius(body.link_spec(link))


def _set_inertia(body: Body, link: int, inertia: Vector3) -> None:
    body.dynamics(link).inertia = inertia
    _write(body, link)


def _write(body: Body, link: int) -> None:
    dynamics = body.dynamics(link)
    body.derived.clear()
    body.world.arrays.write_inertia(body.first_link + 1 + link, dynamics.mass, dynamics.inertia)


def _set_limits(body: Body, joint: int, lower: float, upper: float) -> None:
    dynamics = body.dynamics(joint)
    if lower > upper:
        lower, upper = 1.0, -1.0
    dynamics.joint_lower_limit, dynamics.joint_upper_limit = lower, upper
    if body.velocity_count[joint] == 1:
        body.world.constraints.set_limit(body, joint, lower, upper)
        body.world.scene_changed()


def _set_limit_force(body: Body, joint: int, force: float) -> None:
    """Set the maximum impulse of a limit: the force times the present duration of a substep."""
    impulse = force * body.world.parameters.substep_time
    limit = body.world.constraints.limit_of(body, joint)
    if limit is not None:
        limit.max_impulse = impulse
        body.dynamics(joint).joint_limit_impulse = impulse
        body.world.scene_changed()


def set_present(body: Body, present: bool) -> None:
    """Let a body come or go, or leave it as it is; see `Body.present`."""
    world = body.world
    with uninterrupted:
        world.undo.settle()
        wanted, only = np.array([present]), np.zeros(1, dtype=np.int64)
        change = change_presence(world.arrays, world.contact_arrays, body.rows, only, wanted)

        def apply() -> None:
            change()
            world.scene_changed()

        world.undo.at_once(apply)
