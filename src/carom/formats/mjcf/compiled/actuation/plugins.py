"""Actuators by MuJoCo's plugin `mujoco.pid`: servos, but for what has a memory of its own."""

from __future__ import annotations

from carom.files.xml_element import Element
from carom.formats.mjcf.compiled.actuation.law import (
    AFFINE,
    FILTER,
    FILTER_EXACT,
    FIXED,
    INTEGRATOR,
    NONE,
    Law,
    padded,
)
from carom.formats.mjcf.compiled.context import CompiledContext
from carom.formats.mjcf.defaults import Attributes
from carom.formats.robot.context import shown

_PID = "mujoco.pid"
_KEYS = ("kp", "ki", "kd", "imax", "slewmax")
_DYNAMICS = (NONE, INTEGRATOR, FILTER, FILTER_EXACT)


def apply_plugin(context: CompiledContext, element: Element, attributes: Attributes, law: Law) -> bool:
    """Change a law to that of the plugin of an `<actuator>`'s `<plugin>`; False for other plugins.

    The force of `mujoco.pid` is kp (u - length) + ki times the integral of that - kd times the velocity. What
    has a memory of its own, the integral and a bound of changes of u, is reported.

    Raises:
        DescriptionError: There is no such instance, or a number is broken.
    """
    name, settings = plugin_of(context, element)
    if name != _PID:
        return False
    values = {key: context.singles(element, key, settings.get(key, "0")) or [0.0] for key in _KEYS}
    kp, ki, kd = (values[key][0] for key in ("kp", "ki", "kd"))
    law.shortcut = ""
    law.gain_type, law.gain = FIXED, padded(kp)
    law.bias_type, law.bias = AFFINE, padded(0.0, -kp, -kd)
    law.dynamics = attributes.get("dyntype", NONE)
    if law.dynamics not in _DYNAMICS:
        raise context.error(element, f"dyntype={shown(law.dynamics)} must be one of {', '.join(_DYNAMICS)}")
    if "dynprm" in attributes:
        law.times = [*context.singles(element, "dynprm", attributes["dynprm"]), *law.times][:3]
    if ki:
        context.leave_out(element, "errors that stay are not made up for", "its integral (ki) is not built")
    if "slewmax" in settings:
        context.leave_out(element, "the target may jump", "a bound of its rate (slewmax) is not built")
    if kd and law.dynamics != NONE:
        context.leave_out(
            element, "its damping is of the velocity alone", "the rate of its target is not used"
        )
    element.attributes.get("actdim")
    return True


def memories(context: CompiledContext, element: Element) -> int:
    """How many activations of its own the plugin of an actuator has in MuJoCo, which are not here."""
    name, settings = plugin_of(context, element)
    if name != _PID:
        return 1
    has_integral = any(context.singles(element, "ki", settings.get("ki", "0")))
    return has_integral + ("slewmax" in settings)


def plugin_of(context: CompiledContext, element: Element) -> tuple[str, dict[str, str]]:
    """Name and settings of the plugin of an element, which states them or names an instance that does."""
    attributes = element.attributes
    wanted = attributes.get("instance", "")
    if not wanted:
        return attributes.get("plugin", ""), _settings(element)
    for extension in context.root.all("extension"):
        for plugin in extension.children:
            for instance in plugin.children:
                if instance.attributes.get("name") == wanted:
                    return plugin.attributes.get("plugin", ""), _settings(instance)
    raise context.error(element, f"there is no plugin instance {shown(wanted)}")


def _settings(element: Element) -> dict[str, str]:
    """The `<config>`s in an element: values by key."""
    return {
        config.attributes.get("key", ""): config.attributes.get("value", "")
        for config in element.all("config")
    }
