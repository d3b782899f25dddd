"""`<muscle>`: how the force of an actuator depends on length, velocity and activation."""

from __future__ import annotations

from carom.description.actuator import MuscleSpec
from carom.formats.mjcf.compiled.elements import Scope
from carom.formats.mjcf.defaults import MAIN, Attributes
from carom.formats.reading.cursor import Recorded, layered
from carom.formats.robot.context import shown
from carom.formats.xml_element import Element

_TIMES = (0.01, 0.04)


def times_of(scope: Scope, element: Element) -> tuple[float, float]:
    """Time constants of rising and of falling activation [s]."""
    text = _own(scope, element).get("timeconst", "")
    stated = scope.context.numbers(element, "timeconst", text, 0, 2)
    rising, falling = (*stated, *_TIMES[len(stated) :])
    return rising, falling


def read_muscle(
    scope: Scope, element: Element, attributes: Attributes, limits: tuple[float, float] | None
) -> tuple[MuscleSpec | None, str]:
    """The muscle of an element, and what of it is not built.

    A negative force stands for the acceleration that it causes.

    Args:
        scope: The scope of the element.
        element: The element.
        attributes: All attributes of the actuator.
        limits: Range of its length by the limits of its joint or tendon; None if there are none.
    """
    context, own = scope.context, _own(scope, element)

    def number(name: str, default: float) -> float:
        return context.number(element, own, name, default)

    text = attributes.get("lengthrange")
    if text is not None:
        shortest, longest = context.numbers(element, "lengthrange", text, 2, 2)
    elif limits is not None:
        shortest, longest = limits if limits[0] < limits[1] else limits[::-1]
        context.leave_out(
            element,
            "its range of lengths is that of the limits",
            "MuJoCo simulates to find it",
            "lengthrange",
        )
    else:
        return None, "lengths that a muscle can have are not found; state its lengthrange"
    if not shortest < longest:
        raise context.error(element, f"lengthrange={shown(text or '')}: the first number must be less")
    text = own.get("range", "0.75 1.05")
    lower, upper = context.numbers(element, "range", text, 2, 2)
    fibre = (longest - shortest) / (upper - lower)
    force = number("force", -1.0)
    if force < 0.0:
        # Its force causes this acceleration where the model is at its reference; see `world.file_actuators`.
        force = -number("scale", 200.0)
    falling = times_of(scope, element)[1]
    return MuscleSpec(
        force,
        fibre,
        shortest - lower * fibre,
        number("lmin", 0.5),
        number("lmax", 1.6),
        number("vmax", 1.5),
        number("fpmax", 1.3),
        number("fvmax", 1.2),
        falling,
        number("tausmooth", 0.0),
    ), ""


def _own(scope: Scope, element: Element) -> Attributes:
    """The attributes of an element over the defaults of muscles only."""
    name = element.attributes.get("class") or MAIN
    defaults = scope.context.classes.get(name, {}).get("muscle", {})
    if isinstance(defaults, Recorded):
        defaults.note_use()
    return layered(defaults, element.attributes)
