"""`<pid>`: a servo with targets of length and velocity, and a force to be added.

Its force is kp (u_pos - length) + kv (u_vel - velocity) + u_ff, of which it has some of the inputs u. Each
input is an actuator of its own here: the first one has the name of the element and feels length and velocity,
and the others, called `NAME@vel` and `NAME@ff`, add to it.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace
from math import inf
from typing import Any

from carom.description.actuator import UNBOUNDED
from carom.files.xml_element import Element
from carom.formats.mjcf.compiled.actuation.law import INPUTS, NONE, Law, padded
from carom.formats.mjcf.compiled.elements import Scope
from carom.formats.mjcf.compiled.model import CompiledModel, FileActuator
from carom.formats.mjcf.defaults import Attributes
from carom.formats.robot.context import shown

_RANGES = {"pos": "posrange", "vel": "velrange", "ff": "ffrange"}


def inputs_of(
    scope: Scope, element: Element, attributes: Attributes, law: Law
) -> Iterator[tuple[str, Attributes, Law]]:
    """The inputs of a `<pid>`: what each adds to the name, and its attributes and law as an actuator.

    Raises:
        DescriptionError: Inputs are not some of `pos`, `vel` and `ff` in this order.
    """
    context, inputs = scope.context, law.pid.inputs
    if not inputs or inputs != tuple(it for it in INPUTS if it in inputs):
        raise context.error(
            element,
            f"input={shown(' '.join(inputs))} must be some of pos, vel and ff, in this order, with spaces",
        )
    if law.pid.integral and "pos" not in inputs:
        raise context.error(element, "ki needs the input pos")
    if law.pid.integral:
        context.leave_out(element, "errors that stay are not made up for", "the integral is not built", "ki")
    if law.pid.slew > 0.0:
        context.leave_out(element, "the target may jump", "a bound of its rate is not built", "slewmax")
    for place, name in enumerate(inputs):
        changed = dict(attributes)
        stated = [attributes.get(it) for it in _RANGES.values()][INPUTS.index(name)]
        if stated is not None:
            changed["ctrlrange"] = stated
        if name != "pos":
            # These are those of the first of all possible inputs.
            changed["ctrllimited"] = "false" if stated is None else "true"
        own = law.copy()
        kp, kv = law.gain[0], -law.bias[2]
        own.dynamics = NONE
        own.gain = padded({"pos": kp, "vel": kv, "ff": 1.0}[name])
        if name == "vel" and kv < 0.0:
            context.leave_out(
                element, "the target of its velocity is 0", "its damping is by a dampratio", "input"
            )
            own.gain = padded(0.0)
        if place:
            own.bias = padded()
        elif name != "pos" and kv < 0.0:
            context.leave_out(element, "it does not damp", "a dampratio needs the input pos", "dampratio")
            own.bias = padded(0.0, -kp)
        if name != "pos":
            own.inherited = 0.0
        yield f"@{name}" if place else "", changed, own


def bound_sums(
    model: CompiledModel, joints: Mapping[str, Any], sums: list[tuple[FileActuator, Element, Scope]]
) -> None:
    """Bound the sum of what the inputs of a `<pid>` exert, instead of each of them, where that is possible.

    Args:
        model: All that is in the file.
        joints: By name, the body of each joint and the joint.
        sums: Actuators of inputs that have a `forcerange`, with their elements.
    """
    reported: set[int] = set()
    for made, element, scope in sums:
        spec = made.spec
        if spec is None:
            continue
        mates = {other.name for other, its, of in sums if its is element and of is scope}
        alone = spec.joint and not any(
            other.spec is not None and other.spec.joint == spec.joint and other.name not in mates
            for other in model.actuators
        )
        if alone and joints[spec.joint][1].actuator_range == UNBOUNDED:
            lower, upper = sorted(spec.gear * bound for bound in spec.force_range)
            made.spec = replace(spec, force_range=(-inf, inf), joint_range=(lower, upper))
        elif id(element) not in reported:
            reported.add(id(element))
            scope.context.leave_out(
                element,
                "what each input exerts is bounded, and not the sum",
                "others act there",
                "forcerange",
            )
