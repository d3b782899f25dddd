"""Ranges of an actuator of a file: of controls, forces and activations; and its time constant."""

from __future__ import annotations

from math import inf

from carom.description.actuator import UNBOUNDED
from carom.files.xml_element import Element
from carom.formats.mjcf.compiled.actuation.law import ADHESION, FILTER, FILTER_EXACT, MUSCLE, NONE, Law
from carom.formats.mjcf.compiled.elements import Scope
from carom.formats.mjcf.compiled.joint import is_limited
from carom.formats.mjcf.defaults import Attributes
from carom.formats.robot.context import shown


def has_activation(law: Law) -> bool:
    """Whether an actuator has a state."""
    return law.dynamics != NONE


def range_of(
    scope: Scope, element: Element, attributes: Attributes, kind: str, law: Law
) -> tuple[float, float]:
    """The range of controls, forces or activations."""
    name = f"{kind}range"
    limited = is_limited(scope, element, attributes, f"{kind}limited", name)
    text = attributes.get(name)
    if not limited and (kind not in law.bounded or (text is None and kind != "ctrl")):
        return UNBOUNDED
    if text is None:
        raise scope.context.error(element, f"it needs a {name}")
    lower, upper = scope.context.bounds(element, name, text)
    if lower >= upper:
        raise scope.context.error(element, f"{name}={shown(text)}: the first number must be less")
    if kind == "ctrl" and element.tag in ("damper", ADHESION) and lower < 0.0:
        raise scope.context.error(element, f"{name}={shown(text)} of {element.tag} must not be negative")
    return lower, upper


def within_share(
    scope: Scope, element: Element, law: Law, bounds: tuple[float, float], whose: str
) -> tuple[float, float]:
    """The range of a servo's target from that of its joint or tendon."""
    lower, upper = bounds
    if not -inf < lower <= upper < inf:
        raise scope.context.error(element, f"inheritrange: {whose} has no range to inherit")
    middle, half = 0.5 * (lower + upper), 0.5 * (upper - lower) * law.inherited
    return middle - half, middle + half


def time_of(law: Law) -> float:
    """The time constant of the dynamics; of a muscle that of its rising activation."""
    return law.times[0] if law.dynamics in (FILTER, FILTER_EXACT, MUSCLE) else 1.0
