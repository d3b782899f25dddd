"""Sensors between two sides: `<contact>`, `<distance>`, `<normal>` and `<fromto>` in `<sensor>`."""

from __future__ import annotations

from carom.description.sensor import (
    CONTACT_FIELDS,
    MAX_SAMPLES,
    ContactReduction,
    SensorKind,
    SensorObject,
    SensorSpec,
)
from carom.files.xml_element import Element
from carom.formats.mjcf.compiled.context import CompiledContext
from carom.formats.robot.context import shown

_SIDES = {
    "geom": SensorObject.SHAPE,
    "body": SensorObject.LINK,
    "subtree": SensorObject.SUBTREE,
}
_OF_MUJOCO = (*CONTACT_FIELDS, "linvel", "angvel")


def read_contact_sensor(context: CompiledContext, element: Element) -> tuple[SensorSpec, str]:
    """What an element says of a sensor of contacts, with the names that it states, and what is not built.

    Raises:
        DescriptionError: It is broken.
    """
    attributes = element.attributes
    (first_type, first), (second_type, second) = _sides(context, element, tuple(_SIDES))
    words = attributes.get("data", "found").split()
    known = ", ".join(_OF_MUJOCO)
    if not words or [name for name in _OF_MUJOCO if name in words] != words:
        raise context.error(
            element, f"data={shown(attributes['data'])} must be some of {known}, in this order"
        )
    slots = context.number(element, attributes, "num", 1.0)
    if not 1 <= slots <= MAX_SAMPLES or slots != int(slots):
        raise context.error(element, f"num={shown(attributes['num'])} must be from 1 to {MAX_SAMPLES}")
    reduction = attributes.get("reduce", "none")
    if reduction not in (it.value for it in ContactReduction):
        names = ", ".join(it.value for it in ContactReduction)
        raise context.error(element, f"reduce={shown(reduction)} is none of {names}")
    problem = ""
    if not {*words} <= {*CONTACT_FIELDS}:
        problem = "velocities of contacts are not built"
    elif not first and not second:
        problem = "it is of all contacts, and a sensor is one of a body"
    spec = SensorSpec(
        "",
        SensorKind.CONTACT,
        first_type,
        first,
        second_type,
        second,
        fields=tuple(words),
        slots=int(slots),
        reduction=ContactReduction(reduction),
    )
    return spec, problem


def read_distance_sensor(context: CompiledContext, element: Element, kind: SensorKind) -> SensorSpec:
    """What an element says of a sensor of distance, with the names that it states.

    Raises:
        DescriptionError: It is broken.
    """
    (first_type, first), (second_type, second) = stated = _sides(context, element, ("geom", "body"))
    for number, (what, _) in enumerate(stated, 1):
        if what is SensorObject.NONE:
            raise context.error(element, f"it needs geom{number} or body{number}")
    if stated[0] == stated[1]:
        raise context.error(element, f"both sides are {shown(first)}; its distance is to something else")
    return SensorSpec("", kind, first_type, first, second_type, second)


def _sides(
    context: CompiledContext, element: Element, whats: tuple[str, ...]
) -> tuple[tuple[SensorObject, str], tuple[SensorObject, str]]:
    """The two sides that an element states, each as one of some attributes; NONE for one that it doesn't."""
    attributes = element.attributes
    first, second = (
        [name for name in (f"{what}{number}" for what in whats) if name in attributes] for number in (1, 2)
    )
    if "site" in attributes:
        first.append("site")

    def side(names: list[str]) -> tuple[SensorObject, str]:
        if len(names) > 1:
            raise context.error(element, f"only one of {', '.join(names)} can be stated")
        if not names:
            return SensorObject.NONE, ""
        return _SIDES.get(names[0][:-1], SensorObject.SITE), attributes[names[0]]

    return side(first), side(second)
