"""`<world>`: gravity and time step."""

from __future__ import annotations

from typing import Any

from carom.description.pose import Vector3
from carom.files.xml_element import Element
from carom.formats.sdf.context import SdfContext

_GRAVITY = (0.0, 0.0, -9.8)
_STEP = 0.001

MAGNETIC_FIELD: Vector3 = (5.5645e-6, 22.8758e-6, -42.3884e-6)
"""Of a world that states none [T]."""


def read_options(context: SdfContext, world: Element) -> dict[str, Any]:
    """What a world states, with the format's defaults.

    That is `gravity` [m/s²], `timestep` [s] and `magnetic_field` [T].

    Raises:
        DescriptionError: A number cannot be read, or the time step is not positive.
    """
    gravity, physics = world.first("gravity"), _physics(world)
    options: dict[str, Any] = {"gravity": _GRAVITY if gravity is None else context.triple(world, "gravity")}
    if physics is not None and gravity is None and physics.first("gravity") is not None:
        # Where files of version 1.4 and before had it.
        options["gravity"] = context.triple(physics, "gravity")
    step = _STEP if physics is None else context.value(physics, "max_step_size", _STEP)
    if step <= 0.0:
        raise context.error(physics or world, f"<max_step_size> is {step:g}; expected a positive number")
    options["timestep"] = step
    options["magnetic_field"] = context.triple(world, "magnetic_field") or MAGNETIC_FIELD
    wind = world.first("wind")
    velocity = None if wind is None else context.triple(wind, "linear_velocity")
    if wind is not None and velocity is not None and any(velocity):
        context.leave_out(wind, "there is no wind", "links that feel it need a shape for the air")
    return options


def _physics(world: Element) -> Element | None:
    """The `<physics>` that counts: the one marked as default, else the first."""
    for element in world.children:
        if element.tag == "physics" and element.attributes.get("default") in ("1", "true"):
            element.note()
            return element
    return world.first("physics")
