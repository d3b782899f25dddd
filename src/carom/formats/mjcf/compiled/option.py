"""`<option>`: gravity, time step and the like, as data."""

from __future__ import annotations

from typing import Any

from carom.files.xml_element import Element
from carom.formats.mjcf.compiled.context import CompiledContext
from carom.formats.robot.context import shown

_SCALARS = ("timestep", "density", "viscosity", "impratio", "o_margin")
_VECTORS = ("gravity", "wind", "magnetic")
_WORDS = ("integrator", "cone", "solver", "jacobian")
_OF_ALL_CONTACTS = {
    "o_friction": (1.0, 1.0, 0.005, 0.0001, 0.0001),
    "o_solref": (0.02, 1.0),
    "o_solimp": (0.9, 0.95, 0.001, 0.5, 2.0),
}
"""What contacts have by default where an option overrides what geoms say."""
_INTEGRATORS = ("discrete", "Euler", "implicit", "implicitfast", "RK4")
_UNBUILT_FLAGS = {
    ("sleep", "enable"): "bodies do not fall asleep",
    ("refsafe", "disable"): "constraints yield no faster than in two steps",
    ("sensor", "disable"): "sensors measure",
    ("diagexact", "enable"): "constraints are weighed as at the reference",
    ("ipc", "enable"): "contacts have the law that they have without it",
    ("speculative", "enable"): "contacts begin when shapes touch",
}
"""What follows from flags that have no effect here."""
DEFAULTS: dict[str, Any] = {
    "timestep": 0.002,
    "gravity": (0.0, 0.0, -9.81),
    "o_margin": 0.0,
    **_OF_ALL_CONTACTS,
    # Not MuJoCo's: with less, errors of constraints that yield do not become less; see `Scene.apply_options`.
    "solver_residual_threshold": 1e-11,
}


def read_option(context: CompiledContext, element: Element, options: dict[str, Any]) -> None:
    """Add what an `<option>` states to `options`; flags are under `flag.NAME`, as truth values.

    Raises:
        DescriptionError: A number or a flag is not one.
    """
    attributes = element.attributes
    for name in _SCALARS:
        if name in attributes:
            options[name] = context.number(element, attributes, name, 0.0)
    for name in ("density", "viscosity"):
        if options.get(name, 0.0) < 0.0:
            raise context.error(element, f"{name}={shown(attributes[name])} must not be negative")
    for name in _VECTORS:
        if name in attributes:
            options[name] = tuple(context.numbers(element, name, attributes[name], 3, 3))
    for name, usual in _OF_ALL_CONTACTS.items():
        if name in attributes:
            stated = context.numbers(element, name, attributes[name], 0, len(usual))
            options[name] = (*stated, *usual[len(stated) :])
    for name in _WORDS:
        if name in attributes:
            options[name] = attributes[name]
    integrator = attributes.get("integrator", _INTEGRATORS[0])
    if integrator not in _INTEGRATORS:
        known = ", ".join(_INTEGRATORS[:-1])
        raise context.error(element, f"integrator={integrator!r} must be {known} or {_INTEGRATORS[-1]}")
    passes = context.number(element, attributes, "noslip_iterations", 0.0)
    if passes > 0.0:
        options["noslip_iterations"] = int(passes)
    if "actuatorgroupdisable" in attributes:
        text = attributes["actuatorgroupdisable"]
        groups = context.numbers(element, "actuatorgroupdisable", text, 0, 31)
        options["actuatorgroupdisable"] = tuple(int(group) for group in groups)
    if options.get("timestep", 1.0) <= 0.0:
        raise context.error(element, f"timestep={shown(attributes['timestep'])} must be positive")
    for flags in element.all("flag"):
        for name in list(flags.attributes):
            text = flags.attributes[name]
            if text not in ("enable", "disable"):
                raise context.error(flags, f"{name}={shown(text)} must be enable or disable")
            options[f"flag.{name}"] = text == "enable"
            if (name, text) in _UNBUILT_FLAGS:
                context.leave_out(flags, _UNBUILT_FLAGS[name, text], "not read yet", name)
    sliding, other, _, rolling, last = options.get("o_friction", _OF_ALL_CONTACTS["o_friction"])
    if options.get("flag.override") and (sliding != other or rolling != last):
        context.leave_out(
            element, "friction is as along the first axis", "friction has no directions", "o_friction"
        )
