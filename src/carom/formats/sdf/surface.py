"""`<surface>` of a collision: friction, bounce and stiffness of contacts."""

from __future__ import annotations

from math import pi

from carom.description import ContactParameters
from carom.files.xml_element import Element
from carom.formats.sdf.context import SdfContext

_FRICTION = 1.0
"""Coefficient of friction where none is stated, as the format says."""

_RIGID = 1e12
"""Stiffness [N/m] from which on contacts are rigid: the default of the format."""

# A disc of contact turns against its pressure, which is that of a sphere.
_DISC = 3.0 * pi / 16.0


def read_surface(context: SdfContext, collision: Element) -> ContactParameters:
    """The contact parameters that a `<collision>` states; raises `DescriptionError`."""
    surface = collision.first("surface")
    if surface is None:
        return ContactParameters(lateral_friction=_FRICTION)
    friction, contact = surface.first("friction"), surface.first("contact")
    lateral, rolling, spinning = _FRICTION, None, None
    if friction is not None:
        lateral, rolling = _lateral(context, friction)
        spinning = _spinning(context, friction)
    stiffness, damping = (None, None) if contact is None else _springs(context, contact)
    bounce = surface.first("bounce")
    restitution = None
    if bounce is not None and bounce.first("restitution_coefficient") is not None:
        restitution = context.non_negative(bounce, "restitution_coefficient")
    return ContactParameters(
        lateral_friction=lateral,
        rolling_friction=rolling,
        spinning_friction=spinning,
        restitution=restitution,
        stiffness=stiffness,
        damping=damping,
    )


def _engine(parent: Element, *wanted: str) -> Element | None:
    """The element for one of the engines that states one of some values, of ODE before Bullet."""
    for tag in ("ode", "bullet"):
        element = parent.first(tag)
        if element is not None and any(child.tag in wanted for child in element.children):
            return element
    return None


def _lateral(context: SdfContext, friction: Element) -> tuple[float, float | None]:
    """Coefficients of lateral and of rolling friction."""
    element = _engine(friction, "mu", "mu2", "friction", "friction2")
    bullet = friction.first("bullet")
    rolling = None
    if bullet is not None and bullet.first("rolling_friction") is not None:
        rolling = context.non_negative(bullet, "rolling_friction")
    if element is None:
        return _FRICTION, rolling
    one, other = ("mu", "mu2") if element.tag == "ode" else ("friction", "friction2")
    stated = [_coefficient(context, element, tag) for tag in (one, other)]
    if element.first(one) is None:
        stated[0] = stated[1]
    if element.first(other) is not None and stated[1] != stated[0]:
        context.leave_out(
            element, f"<{one}> is the friction in all directions", "friction has no directions", other
        )
    return stated[0], rolling


def _coefficient(context: SdfContext, element: Element, tag: str) -> float:
    """A coefficient of friction; one below 0 stands for friction without bound in ODE."""
    value = context.value(element, tag, _FRICTION)
    if value >= 0.0:
        return value
    context.leave_out(element.first(tag) or element, "friction is 1", "friction without bound is not built")
    return _FRICTION


def _spinning(context: SdfContext, friction: Element) -> float | None:
    """Torque about the normal per normal force [m]; None where none is stated."""
    element = friction.first("torsional")
    if element is None:
        return None
    coefficient = context.value(element, "coefficient", 1.0)
    if not context.says(element, "use_patch_radius", default=True):
        if element.first("surface_radius") is not None:
            context.leave_out(
                element, "it does not resist spinning", "patches do not grow with the depth of contacts"
            )
        return None
    radius = context.value(element, "patch_radius", 0.0) * context.scale
    return coefficient * _DISC * radius if radius > 0.0 else None


def _springs(context: SdfContext, contact: Element) -> tuple[float | None, float | None]:
    """Stiffness [N/m] and damping [N s/m] of contacts; None for rigid ones."""
    element = _engine(contact, "kp", "kd")
    if element is None:
        return None, None
    stiffness = context.value(element, "kp", _RIGID)
    damping = context.value(element, "kd", 1.0)
    if stiffness >= _RIGID or stiffness <= 0.0:
        return None, None
    return stiffness, max(damping, 0.0)
