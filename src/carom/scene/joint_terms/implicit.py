"""Armature, damping and springs of joints: what can be set during the simulation."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from math import sqrt
from typing import TYPE_CHECKING, Any

from carom.layouts.codes import BALLS
from carom.model.builder import BASE_POSITIONS, has_base_terms
from carom.native.change import Change

if TYPE_CHECKING:
    import numpy as np

    from carom.model.link_dynamics import LinkDynamics
    from carom.scene.core.body_core import BodyCore

SPRING_REFERENCE = "joint_spring_reference"
# Fields of `Model` over dofs, by the names of terms in `LinkDynamics`; that of damping depends on the body.
OF_DOFS = {"joint_armature": "dof_armature", "joint_stiffness": "dof_stiffness"}
TERMS = ("joint_damping", *OF_DOFS, SPRING_REFERENCE)


def checked_terms(body: BodyCore, joint: int, changes: Mapping[str, Any]) -> dict[str, Any]:
    """The terms among the changes of a joint's dynamics.

    Raises:
        ValueError: A term is negative, the joint has no such term, or the reference does not fit it.
    """
    terms = {name: changes[name] for name in TERMS if name in changes}
    for name, value in terms.items():
        if name == SPRING_REFERENCE:
            terms[name] = _reference(body, joint, value)
        elif value < 0.0 and (name in OF_DOFS or not body.spec.is_held):
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
    _write_terms(change.arrays(body.world.arrays.model.numpy), body, joint, after)
    if "joint_armature" in terms:
        change.set(body, "derived", {})


def note_all_terms(change: Change, body: BodyCore, joint: int, dynamics: LinkDynamics) -> None:
    """Write the terms in the dynamics that a joint will have to the engine, with a change."""
    _write_terms(change.arrays(body.world.arrays.model.numpy), body, joint, dynamics)


def _write_terms(model: Mapping[str, np.ndarray], body: BodyCore, joint: int, dynamics: LinkDynamics) -> None:
    """Write the terms of a joint to the arrays of the model; `dynamics` are those it has then."""
    first, count = body.velocity_index[joint], body.velocity_count[joint]
    dofs = slice(first, first + count)
    model[body.spec.damping_field][:, dofs] = dynamics.joint_damping
    for name, field in OF_DOFS.items():
        model[field][:, dofs] = getattr(dynamics, name)
    if dynamics.joint_spring_reference:
        first, count = body.position_index[joint], body.position_count[joint]
        model["position_spring"][:, first : first + count] = dynamics.joint_spring_reference
    links = [*body.all_dynamics[1:]]
    links[joint] = dynamics
    model["tree_joint_terms"][:, body.rows.tree] = has_base_terms(body.spec) or any(
        map(body_term_check(body), links)
    )


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
