"""Muscles: how the force of an actuator depends on length, velocity and activation."""

from __future__ import annotations

from carom.description.actuator import MuscleSpec
from carom.files.xml_element import Element
from carom.formats.mjcf.compiled.actuation.law import MUSCLE, Law
from carom.formats.mjcf.compiled.elements import Scope
from carom.formats.mjcf.defaults import Attributes

# Places of the parameters of the passive force that have to be those of the active one, and their names.
_SHARED = {0: "range", 1: "range", 5: "lmax"}


def read_muscle(
    scope: Scope,
    element: Element,
    attributes: Attributes,
    law: Law,
    lengths: tuple[float, float] | None,
    doubt: str = "",
) -> tuple[MuscleSpec | None, str]:
    """The muscle of an element, and what of it is not built.

    A negative force stands for the acceleration that it causes.

    Args:
        scope: The scope of the element.
        element: The element, a `<muscle>` or a general actuator with a gain of this type.
        attributes: All attributes of the actuator.
        law: Its law.
        lengths: Range of its length by limits; None if it was not found.
        doubt: Why MuJoCo's simulation may find another one; empty if it does not.
    """
    context = scope.context
    shortest, longest = context.numbers(element, "lengthrange", attributes.get("lengthrange", "0 0"), 2, 2)
    if not shortest < longest:
        # As if there were none.
        if lengths is None:
            return None, "lengths that a muscle can have are not found; state its lengthrange"
        shortest, longest = lengths if lengths[0] < lengths[1] else lengths[::-1]
        if doubt:
            context.leave_out(element, "its range of lengths may be another one", doubt, "lengthrange")
    lower, upper, force, scale, lmin, lmax, vmax, _, fvmax, *_ = law.gain
    for problem in (
        "" if lower < upper else "range[0] < range[1]",
        "" if lmin < 1.0 < lmax else "lmin < 1 < lmax",
        "" if vmax > 0.0 and fvmax > 0.0 else "vmax > 0 and fvmax > 0",
    ):
        if problem:
            raise context.error(element, f"a muscle needs {problem}")
    fibre = (longest - shortest) / (upper - lower)
    has_times = law.dynamics == MUSCLE
    return MuscleSpec(
        # Its force causes this acceleration where the model is at its reference; see `world.file_actuators`.
        force if force >= 0.0 else -scale,
        fibre,
        shortest - lower * fibre,
        lmin,
        lmax,
        vmax,
        _passive(scope, element, law),
        fvmax,
        law.times[1] if has_times else 1.0,
        law.times[2] if has_times else 0.0,
    ), ""


def _passive(scope: Scope, element: Element, law: Law) -> float:
    """The passive force at the longest length, per greatest active force."""
    if law.bias_type != MUSCLE:
        return 0.0
    force, scale = ((values[2], values[3]) for values in (law.gain, law.bias))
    active, passive = (it[0] if it[0] >= 0.0 else -it[1] for it in (force, scale))
    others = sorted({name for place, name in _SHARED.items() if law.gain[place] != law.bias[place]})
    share = 1.0
    if passive != active:
        if active * passive > 0.0:
            share = passive / active
        else:
            others.append("force")
    if others:
        names = ", ".join(others)
        scope.context.leave_out(
            element, f"its passive force has the {names} of the active one", "both have one", "biasprm"
        )
    return law.bias[7] * share
