"""`<transmission>`: a motor on a joint, behind a reduction; `drake:` inertia of rotors."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from math import inf
from typing import TYPE_CHECKING

from carom.description import Joint
from carom.description.joint import ONE_AXIS
from carom.files.xml_element import Element
from carom.formats.robot.context import FileContext

if TYPE_CHECKING:
    from carom.description.actuator import ActuatorSpec

_LOST = "nothing drives its joint but the motor of the joint"
_SIMPLE = "SimpleTransmission"


def read_transmissions(context: FileContext, joints: Sequence[Joint]) -> tuple[ActuatorSpec, ...]:
    """The motors that simple transmissions describe: the joint feels the reduction times the force.

    Their force is bounded so that the joint gets at most its effort limit. A transmission without a
    reduction is one of 1. Transmissions of other kinds are reported.

    Raises:
        DescriptionError: A name is missing, or a reduction is not a number.
    """
    by_name = {joint.name: joint for joint in joints}
    from carom.description.actuator import Motor

    motors: dict[str, ActuatorSpec] = {}
    for element in context.root.all("transmission"):
        stated = list(element.all("joint"))
        driving = list(element.all("actuator"))
        kind = _text(element, "type") or element.attributes.get("type", _SIMPLE)
        if _SIMPLE not in kind or len(stated) != 1 or len(driving) != 1:
            reason = "only simple transmissions are built, of one actuator to one joint"
            context.leave_out(element, _LOST, reason)
            continue
        name = context.required(stated[0], "name")
        joint = by_name.get(name)
        if joint is None:
            context.leave_out(element, "nothing is driven by it", f"there is no joint {name!r}")
            continue
        reduction = _reduction(context, element, stated[0], driving[0])
        for part in (stated[0], driving[0]):
            for interface in part.all("hardwareInterface"):
                interface.note()
        own = driving[0].attributes.get("name") or element.attributes.get("name", "")
        if joint.type not in ONE_AXIS or reduction == 0.0 or not own or own in motors:
            reason = "its actuator needs a name of its own, a reduction other than 0, and a joint that moves"
            context.leave_out(element, _LOST, reason)
            continue
        bound = joint.limit.effort / abs(reduction) if joint.limit.effort > 0.0 else inf
        motors[own] = Motor(name, reduction, force_range=(-bound, bound)).spec(own)
    return tuple(motors.values())


def _reduction(context: FileContext, element: Element, *parts: Element) -> float:
    """The product of all reductions that a transmission states; 1 without any."""
    reduction = 1.0
    for owner in (element, *parts):
        for stated in owner.all("mechanicalReduction"):
            reduction *= context.parse_number(stated, "mechanicalReduction", stated.text.strip())
    return reduction


def _text(element: Element, tag: str) -> str:
    child = element.first(tag)
    return "" if child is None else child.text.strip()


def with_rotor(context: FileContext, element: Element, joint: Joint) -> Joint:
    """A joint with the inertia of its drive: of `drake:rotor_inertia`, times the square of the gear ratio."""
    inertia = context.child_value(element, "drake:rotor_inertia", 0.0)
    ratio = context.child_value(element, "drake:gear_ratio", 1.0)
    if inertia < 0.0:
        raise context.error(element, f"drake:rotor_inertia={inertia:g} must not be negative")
    return replace(joint, armature=inertia * ratio * ratio) if inertia else joint
