"""How a geom touches others: friction, and how contacts yield."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from carom.description import ContactParameters
from carom.description.compliance import Compliance, ContactCompliance
from carom.files.xml_element import Element
from carom.formats.mjcf.compiled.elements import Scope
from carom.formats.mjcf.compiled.softness import read_compliance

# All that it follows from, but for options.
_ATTRIBUTES = ("friction", "condim", "solref", "solimp", "solmix", "margin", "priority")
_FRICTION = (1.0, 0.005, 0.0001)
_MIN_WEIGHT = 1e-20
"""It counts as 0, and says that there is one."""
_EQUAL_RANK = 1000
"""Rank of friction at priority 0."""
# Ranks have 32 bits.
_GREATEST_PRIORITY = (1 << 31) - 1 - _EQUAL_RANK


def read_contact(
    scope: Scope, element: Element, options: Mapping[str, Any], *, is_mesh: bool
) -> ContactParameters:
    """Friction, compliance and motion of the surface of a geom that collides.

    An option can override what geoms say of the first two. `is_mesh` is as that of `Geom`.
    """
    context, attributes = scope.context, scope.attributes(element)
    texts = tuple([attributes.get(name) for name in _ATTRIBUTES])
    found = context.contacts.get(texts)
    if found is None:
        found = context.contacts[texts] = _read_contact(scope, element, options)
    motion = _surface_motion(scope, element, is_mesh=is_mesh)
    return found if motion is None else replace(found, surface_motion=motion)


def _read_contact(scope: Scope, element: Element, options: Mapping[str, Any]) -> ContactParameters:
    context, attributes = scope.context, scope.attributes(element)
    values = context.singles(element, "friction", attributes.get("friction", ""))
    sliding, spinning, rolling = (*values, *_FRICTION[len(values) :])[:3]
    dimensions = int(context.number(element, attributes, "condim", 3.0))
    compliance = read_compliance(scope, element, attributes)
    weight = max(_MIN_WEIGHT, context.number(element, attributes, "solmix", 1.0))
    margin = context.number(element, attributes, "margin", 0.0)
    if options.get("flag.override", False):
        sliding, _, spinning, rolling, _ = options["o_friction"]
        compliance = Compliance(*options["o_solref"], *options["o_solimp"])
        # The margins of two bodies add up, and their weights count.
        weight, margin = 1.0, 0.5 * options["o_margin"]
    priority = int(context.number(element, attributes, "priority", 0.0))
    if abs(priority) > _GREATEST_PRIORITY:
        raise context.error(
            element, f"priority={priority} must be from -{_GREATEST_PRIORITY} to {_GREATEST_PRIORITY}"
        )
    return ContactParameters(
        friction_rank=max(1, _EQUAL_RANK + priority),
        friction_dimensions=dimensions,
        lateral_friction=sliding,
        spinning_friction=spinning,
        rolling_friction=rolling,
        compliance=ContactCompliance(
            compliance,
            weight,
            margin,
            _pyramids(options),
        ),
    )


def _surface_motion(
    scope: Scope, element: Element, *, is_mesh: bool
) -> tuple[float, float, float, float, float, float] | None:
    text = scope.attributes(element).get("surfacevel")
    if text is None:
        return None
    numbers = [*scope.context.numbers(element, "surfacevel", text, 1, 6), *[0.0] * 5]
    if not any(numbers):
        return None
    if is_mesh:
        scope.context.leave_out(
            element, "the surface does not move", "it is stated along principal axes of a mesh", "surfacevel"
        )
        return None
    x, y, z, turning_x, turning_y, turning_z = numbers[:6]
    return (x, y, z, turning_x, turning_y, turning_z)


def _pyramids(options: Mapping[str, Any]) -> float:
    """See `ContactCompliance.pyramids`."""
    share = 1.0 / max(options.get("impratio", 1.0), 1e-15)
    if options.get("cone", "pyramidal") == "elliptic":
        return 0.0 if share == 1.0 else -share
    return share
