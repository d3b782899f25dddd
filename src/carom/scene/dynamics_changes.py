"""Changing the inertia, the surface or the bounds of a body while it runs."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from carom.layouts.flags import ActivationChange, LoadFlags
from carom.model.body_spec import BASE
from carom.model.inertia import inertia_from_shapes

if TYPE_CHECKING:
    from carom.description.pose import Vector3
    from carom.scene.body import Body


OF_BODY = {
    "linear_damping": "tree_linear_damping",
    "angular_damping": "tree_angular_damping",
    "max_joint_velocity": "tree_max_velocity",
}
_SLEEP_THRESHOLD = "sleep_threshold"
_ACTIVATION = "activation_state"
_OF_JOINT = ("joint_damping", "joint_lower_limit", "joint_upper_limit")
_NOT_OF_SURFACE = {
    *OF_BODY,
    _SLEEP_THRESHOLD,
    _ACTIVATION,
    *_OF_JOINT,
    "mass",
    "inertia",
    "joint_limit_force",
}


def change_dynamics(body: Body, link: int, changes: Mapping[str, Any]) -> None:
    """Change a link, the joint that carries it, or what holds for all links of a body."""
    dynamics, world = body.dynamics(link), body.world
    surface = [name for name in changes if name not in _NOT_OF_SURFACE]
    if surface:
        for name in surface:
            setattr(dynamics, name, changes[name])
        looks_ahead = world.contact_arrays.shapes.looks_ahead
        world.contact_arrays.shapes.write_surface(body.first_link + 1 + link, dynamics, surface)
        if looks_ahead != world.contact_arrays.shapes.looks_ahead:
            world.scene_changed()
        if len(surface) == len(changes):
            return
    for name, field in OF_BODY.items():
        if name in changes:
            world.arrays.model.numpy[field][:, body.rows.tree] = changes[name]
    if _SLEEP_THRESHOLD in changes:
        world.arrays.model.numpy["tree_sleep_threshold"][body.rows.tree] = changes[_SLEEP_THRESHOLD]
    if _ACTIVATION in changes:
        _change_activation(body, ActivationChange(changes[_ACTIVATION]))
    if "mass" in changes:
        _set_mass(body, link, changes["mass"], changes.get("inertia"))
    elif "inertia" in changes:
        _set_inertia(body, link, changes["inertia"])
    if link != BASE:
        _change_joint(body, link, changes)
    else:
        for name in changes.keys() & _OF_JOINT:
            setattr(dynamics, name, changes[name])
    if "joint_limit_force" in changes:
        _set_limit_force(body, link, changes["joint_limit_force"])


def _change_activation(body: Body, change: ActivationChange) -> None:
    """Put a body to sleep, wake it up, or change whether it may do so by itself.

    As in Bullet it takes effect at the end of the next step, and a body that must not wake up keeps
    whether it can sleep.
    """
    model, state = body.world.arrays.model.numpy, body.world.arrays.state.numpy
    tree = body.rows.tree
    if change & ActivationChange.WAKE_UP:
        state["tree_wants_sleep"][0, tree], state["tree_idle_time"][0, tree] = False, 0.0
    if change & ActivationChange.SLEEP:
        state["tree_wants_sleep"][0, tree] = True
    if model["tree_can_wake"][tree]:
        if change & ActivationChange.ENABLE_SLEEPING:
            model["tree_can_sleep"][tree] = True
        if change & ActivationChange.DISABLE_SLEEPING:
            model["tree_can_sleep"][tree] = False
    if change & ActivationChange.ENABLE_WAKEUP:
        model["tree_can_wake"][tree] = True
    if change & ActivationChange.DISABLE_WAKEUP:
        model["tree_can_wake"][tree] = False
    body.world.scene_changed()


def _change_joint(body: Body, joint: int, changes: Mapping[str, Any]) -> None:
    dynamics = body.dynamics(joint)
    if "joint_damping" in changes:
        _set_joint_damping(body, joint, changes["joint_damping"])
    if "joint_lower_limit" in changes or "joint_upper_limit" in changes:
        lower = changes.get("joint_lower_limit", dynamics.joint_lower_limit)
        _set_limits(body, joint, lower, changes.get("joint_upper_limit", dynamics.joint_upper_limit))


def write_link(body: Body, link: int) -> None:
    """Bring the engine up to date with `Body.dynamics` of a link, but for the bounds of its joint."""
    dynamics = body.dynamics(link)
    _write(body, link)
    if link != BASE:
        _set_joint_damping(body, link, dynamics.joint_damping)
    body.world.contact_arrays.shapes.write_surface(body.first_link + 1 + link, dynamics)


def _set_mass(body: Body, link: int, mass: float, inertia: Vector3 | None) -> None:
    """Set the mass and the inertia, by default that of the collision shapes; a massless base is fixed."""
    dynamics = body.dynamics(link)
    dynamics.mass = mass
    dynamics.inertia = shape_inertia(body, link, mass) if inertia is None else inertia
    _write(body, link)
    if link == BASE and (mass > 0.0) == body.fixed_base:
        body.world.set_base_freedom(body, free=mass > 0.0)
        body.world.contact_arrays.shapes.set_default_group(body.first_link, fixed=mass == 0.0)


def shape_inertia(body: Body, link: int, mass: float) -> Vector3:
    """Principal moments [kg m²] that the collision shapes of a link have at a mass [kg]."""
    spec = body.link_spec(link)
    return inertia_from_shapes(
        mass,
        spec.collisions,
        spec.inertial_frame,
        implicit_cylinder=bool(body.spec.flags & LoadFlags.USE_IMPLICIT_CYLINDER),
        compound_margin=spec.compound_margin,
    )


def _set_inertia(body: Body, link: int, inertia: Vector3) -> None:
    body.dynamics(link).inertia = inertia
    _write(body, link)


def _write(body: Body, link: int) -> None:
    dynamics = body.dynamics(link)
    body.derived.clear()
    body.world.arrays.write_inertia(body.first_link + 1 + link, dynamics.mass, dynamics.inertia)


def _set_joint_damping(body: Body, joint: int, damping: float) -> None:
    body.dynamics(joint).joint_damping = damping
    first = body.velocity_index[joint]
    body.world.arrays.model.numpy["dof_damping"][:, first : first + body.velocity_count[joint]] = damping


def _set_limits(body: Body, joint: int, lower: float, upper: float) -> None:
    dynamics = body.dynamics(joint)
    if lower > upper:
        lower, upper = 1.0, -1.0
    dynamics.joint_lower_limit, dynamics.joint_upper_limit = lower, upper
    if body.velocity_count[joint] == 1:
        body.world.constraints.set_limit(body, joint, lower, upper)
        body.world.scene_changed()


def _set_limit_force(body: Body, joint: int, force: float) -> None:
    """A limit's bound is an impulse: it keeps the substep at the time of the call."""
    impulse = force * body.world.parameters.substep_time
    limit = body.world.constraints.limit_of(body, joint)
    if limit is not None:
        limit.max_impulse = impulse
        body.dynamics(joint).joint_limit_impulse = impulse
        body.world.scene_changed()
