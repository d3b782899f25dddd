"""Adding actuators to bodies, and changing them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from carom.checks import finite, not_negative
from carom.description.actuator import Actuator, ActuatorSpec
from carom.errors import DescriptionError
from carom.layouts.codes import ConstraintKind
from carom.model.actuator_rows import (
    check_joint_ranges,
    join_actuators,
    pulled_link,
    write_actuator,
)
from carom.native.change import Change
from carom.native.gates import gated
from carom.scene.actuators.actuated_joint import actuated_joint, drives_joint, needs_transmission
from carom.scene.common.actuator import OF_BIAS
from carom.scene.handles import world_of
from carom.scene.joint_constraints import JointConstraint
from carom.scene.tendons.making import new_transmission

if TYPE_CHECKING:
    from carom.scene.core.body_core import BodyCore


@gated("world.call_lock")
def add_actuator(body: BodyCore, name: str, actuator: Actuator) -> None:
    """Add an actuator to a body, as `Body.add_actuator` does."""
    world, spec = world_of(body), actuator.spec(name)
    spec.check()
    if not name or any(other.name == name for other in body.spec.actuators):
        raise DescriptionError(f"actuator {name!r}: each one of a body needs a name of its own")
    check_joint_ranges((*body.spec.actuators, spec))
    pulled_link(body.spec, spec)
    number = len(body.spec.actuators)
    change = Change(world.change_scene)
    made: JointConstraint | None = None
    if drives_joint(spec):
        joint = actuated_joint(body, spec)
        made = JointConstraint(body, joint, ConstraintKind.ACTUATOR, actuator=number)
    elif needs_transmission(spec):
        transmission = new_transmission(body, number, spec)
        made = JointConstraint(body, transmission.parent_link, ConstraintKind.USER, user=transmission)
        world.user_constraints.put(change, transmission)
    others = [other.rows for other in world.bodies.values()]
    row = world.arrays.insert(change, body.rows, others, "actuator", 1)
    model, specs = change.arrays(world.arrays.model.numpy), (*body.spec.actuators, spec)
    for other in others:
        if other.tree > body.rows.tree:
            model["tree_first_actuator"][other.tree] += 1
    model["tree_actuator_count"][body.rows.tree] += 1
    write_actuator(model, row, spec)
    model["actuator_pulled"][row] = pulled_link(body.spec, spec)
    join_actuators(model, body.rows.first["actuator"], specs)
    change.set(body, "spec", replace(body.spec, actuators=specs))
    change.extend(world.joint_constraints.all, [] if made is None else [made])
    change.drop(body.__dict__, "actuators")
    world.change_scene(change)
    change.commit()


_SETTABLE = (
    *("gear", "gain", "bias", "time_constant"),
    *("control_range", "force_range", "activation_range", "joint_range"),
)


@gated("world.call_lock")
def change_actuator(body: BodyCore, number: int, changes: Mapping[str, Any]) -> None:
    """Change parameters of an actuator, as `BodyActuator.change` does."""
    world = world_of(body)
    unknown = [name for name in changes if name not in (*_SETTABLE, *OF_BIAS)]
    if unknown:
        raise TypeError(
            f"actuators have no parameter {unknown[0]!r}; they have {', '.join((*OF_BIAS, *_SETTABLE))}"
        )
    if "bias" in changes and not OF_BIAS.keys().isdisjoint(changes):
        raise TypeError("kp and kv are parts of bias: give one of them")
    spec = replace(
        body.spec.actuators[number],
        **{name: _read(name, value) for name, value in changes.items() if name not in OF_BIAS},
    )
    for name in OF_BIAS:
        if name in changes:
            spec = _servo(spec, name, float(not_negative(finite(changes[name], name), name)))
    spec.check()
    specs = (*body.spec.actuators[:number], spec, *body.spec.actuators[number + 1 :])
    check_joint_ranges(specs)
    change = Change(world.change_scene)
    model = change.arrays(world.arrays.model.numpy)
    first = body.rows.first["actuator"]
    write_actuator(model, first + number, spec)
    join_actuators(model, first, specs)
    change.set(body, "spec", replace(body.spec, actuators=specs))
    world.change_scene(change)
    change.commit()


def _read(name: str, value: Any) -> Any:
    """A number, or a tuple of several; bounds may be infinite."""
    if name in ("gear", "time_constant"):
        return float(finite(value, name))
    numbers = tuple(float(number) for number in value)
    wanted = 3 if name in ("gain", "bias") else 2
    if len(numbers) != wanted:
        raise ValueError(f"{name} must be {wanted} numbers, not {value!r}")
    return numbers


def _servo(spec: ActuatorSpec, name: str, value: float) -> ActuatorSpec:
    """With another stiffness or damping; its control counts as its stiffness, or that of a velocity does."""
    place = OF_BIAS[name]
    bias, gain = list(spec.bias), list(spec.gain)
    if gain[0] == -bias[place]:
        gain[0] = value
    bias[place] = -value
    a, b, c = gain
    d, e, f = bias
    return replace(spec, gain=(a, b, c), bias=(d, e, f))
