"""Armature, damping and springs of joints: what can be set during the simulation."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from math import sqrt
from typing import TYPE_CHECKING, Any

from carom.layouts.codes import BALLS
from carom.layouts.dynamics_parameters import JOINT_TERMS
from carom.model.builder import BASE_POSITIONS, has_base_terms
from carom.native.change import Change
from carom.scene.dynamics.places import note

if TYPE_CHECKING:
    from carom.model.link_dynamics import LinkDynamics
    from carom.scene.core.body_core import BodyCore

DAMPING, ARMATURE, SPRING_REFERENCE = "joint_damping", "joint_armature", "joint_spring_reference"


def checked_terms(body: BodyCore, joint: int, changes: Mapping[str, Any]) -> dict[str, Any]:
    """The terms among the changes of a joint's dynamics.

    Raises:
        ValueError: A term is negative, the joint has no such term, or the reference does not fit it.
    """
    terms = {name: changes[name] for name in JOINT_TERMS if name in changes}
    for name, value in terms.items():
        if name == SPRING_REFERENCE:
            terms[name] = _reference(body, joint, value)
        elif value < 0.0 and (name != DAMPING or not body.spec.is_held):
            raise ValueError(f"{name} is {value}: it must not be negative")
    return terms


def _reference(body: BodyCore, joint: int, value: Any) -> tuple[float, ...]:
    numbers = tuple(float(number) for number in (value if hasattr(value, "__len__") else (value,)))
    count = body.position_count[joint]
    if len(numbers) != count:
        name = body.spec.links[joint].joint_name
        raise ValueError(f"joint_spring_reference has {len(numbers)} numbers; joint {name!r} has {count}")
    if body.joint_types[joint] in BALLS:
        size = sqrt(sum(number * number for number in numbers))
        if not size > 0.0:
            raise ValueError("joint_spring_reference must be a quaternion other than 0")
        numbers = tuple(number / size for number in numbers)
    return numbers


def note_terms(change: Change, body: BodyCore, joint: int, terms: Mapping[str, Any]) -> None:
    """Set terms that were checked, with a change."""
    dynamics = body.dynamics(joint)
    after = dynamics.copy()
    for name, value in terms.items():
        change.set(dynamics, name, value)
        setattr(after, name, value)
        note(change, body.world, body, joint, name, value)
    _note_use(change, body, joint, after)
    if ARMATURE in terms:
        change.set(body, "derived", {})


def write_terms(change: Change, body: BodyCore, joint: int, dynamics: LinkDynamics) -> None:
    """Write all terms in the dynamics that a joint will have to the engine, with a change."""
    for name in JOINT_TERMS:
        value = getattr(dynamics, name)
        if value != ():
            note(change, body.world, body, joint, name, value)
    _note_use(change, body, joint, dynamics)


def _note_use(change: Change, body: BodyCore, joint: int, dynamics: LinkDynamics) -> None:
    """Note whether a body has such terms; `dynamics` are those that one of its joints will have."""
    links = [*body.all_dynamics[1:]]
    links[joint] = dynamics
    used = has_base_terms(body.spec) or any(map(body_term_check(body), links))
    change.write(body.world.arrays.model.numpy["tree_joint_terms"][:, body.rows.tree], used)


def rest_base_spring(body: BodyCore) -> None:
    """Let the spring of a free base be at rest at its present pose."""
    arrays, first = body.world.arrays, body.rows.first["position"]
    rest = arrays.state.numpy["position"][0, first : first + BASE_POSITIONS].tolist()
    body.spec = replace(body.spec, base_rest=tuple(rest))
    arrays.model.numpy["position_spring"][:, first : first + BASE_POSITIONS] = rest


def body_term_check(body: BodyCore) -> Any:
    """A function that tells whether a joint of the body has terms that are implicit in velocity."""
    implicit = not body.spec.is_held

    def has_terms(dynamics: LinkDynamics) -> bool:
        return bool(
            dynamics.joint_armature or dynamics.joint_stiffness or (implicit and dynamics.joint_damping)
        )

    return has_terms
