"""`<joint>`: one of the joints of a body, in double precision and with MuJoCo's defaults."""

from __future__ import annotations

from math import hypot, inf

from carom.description import Joint, JointLimit
from carom.description.joint import BALL, HINGE, SLIDER, UNLIMITED
from carom.description.pose import Vector3
from carom.description.transform import rotate
from carom.files.xml_element import Element
from carom.formats.mjcf.compiled.elements import Scope
from carom.formats.mjcf.compiled.model import BallLimit, CompiledJoint
from carom.formats.mjcf.compiled.softness import read_compliance
from carom.formats.mjcf.defaults import Attributes
from carom.formats.robot.context import shown

FREE = "free"
_TYPES = {"hinge": HINGE, "slide": SLIDER, "ball": BALL}
_UNLIMITED = (0.0, -1.0)


def joint_type(scope: Scope, element: Element) -> str:
    """The type of a `<joint>`."""
    kind = scope.attributes(element).get("type", "hinge")
    if kind != FREE and kind not in _TYPES:
        raise scope.context.error(element, f"unknown joint type {shown(kind)}")
    return kind


def read_joint(scope: Scope, element: Element) -> CompiledJoint:
    """The joint that a `<joint>` other than a free one describes; raises `DescriptionError`."""
    context, attributes = scope.context, scope.attributes(element)
    kind = joint_type(scope, element)
    anchor = scope.point(_triple(scope, element, attributes, "pos", (0.0, 0.0, 0.0)))
    axis = _axis(scope, element, attributes)
    lower, upper = _range(scope, element, attributes, kind)
    limited = lower <= upper
    turn_limit: BallLimit | None = None
    if kind == "ball" and limited:
        margin = context.number(element, attributes, "margin", 0.0)
        turn_limit = BallLimit(
            max(lower, upper), read_compliance(scope, element, attributes, "limit"), margin
        )
        lower, upper = _UNLIMITED
        limited = False
    described = _TYPES[kind]
    if kind == "hinge" and not limited:
        described = UNLIMITED[described]
    damping = first_number(scope, element, attributes, "damping", may_drive=True)
    friction = first_number(scope, element, attributes, "frictionloss")
    reference = 0.0 if kind == "ball" else _position(scope, element, attributes, "ref", kind)
    bounds = actuator_range(scope, element, attributes)
    joint = Joint(
        scope.name(element),
        described,
        0,
        0,
        axis=axis,
        limit=JointLimit(lower, upper, effort=_effort(bounds)),
        damping=damping,
        friction=friction,
        armature=first_number(scope, element, attributes, "armature"),
        stiffness=first_number(scope, element, attributes, "stiffness"),
        spring_reference=0.0 if kind == "ball" else _position(scope, element, attributes, "springref", kind),
        limit_compliance=read_compliance(scope, element, attributes, "limit") if limited else None,
        limit_margin=context.number(element, attributes, "margin", 0.0) if limited else 0.0,
        friction_compliance=read_compliance(scope, element, attributes, "friction") if friction else None,
    )
    time_constant, ratio = context.numbers(
        element, "springdamper", attributes.get("springdamper", "0 0"), 2, 2
    )
    return CompiledJoint(
        joint, anchor, reference, element, context, bounds, (time_constant, ratio), turn_limit
    )


def _triple(scope: Scope, element: Element, attributes: Attributes, name: str, default: Vector3) -> Vector3:
    text = attributes.get(name)
    if text is None:
        return default
    x, y, z = scope.context.numbers(element, name, text, 3, 3)
    return (x, y, z)


def _axis(scope: Scope, element: Element, attributes: Attributes) -> Vector3:
    """Unit axis in the body's frame; along z where there is none."""
    x, y, z = rotate(scope.into.orientation, _triple(scope, element, attributes, "axis", (0.0, 0.0, 1.0)))
    length = hypot(x, y, z)
    if length == 0.0:
        raise scope.context.error(element, "the axis has no length")
    return (x / length, y / length, z / length)


def _position(scope: Scope, element: Element, attributes: Attributes, name: str, kind: str) -> float:
    value = scope.context.number(element, attributes, name, 0.0)
    return scope.context.angle(value) if kind == "hinge" else value


def _range(scope: Scope, element: Element, attributes: Attributes, kind: str) -> tuple[float, float]:
    """Lower and upper limit [rad or m]; lower > upper if there are none."""
    if not is_limited(scope, element, attributes, "limited", "range"):
        return _UNLIMITED
    text = attributes.get("range", "0 0" if kind == "ball" else None)
    if text is None:
        raise scope.context.error(element, "a limited joint needs a range")
    lower, upper = scope.context.bounds(element, "range", text)
    if -lower == upper == inf:
        return _UNLIMITED
    if kind in ("hinge", "ball"):
        lower, upper = scope.context.angle(lower), scope.context.angle(upper)
    if lower > upper:
        raise scope.context.error(
            element, f"range={shown(text)}: the first number must be less than the second"
        )
    return lower, upper


def is_limited(scope: Scope, element: Element, attributes: Attributes, name: str, bounds: str) -> bool:
    """Whether `limited` or the like holds: stated, or, with `autolimits`, there is a range."""
    context = scope.context
    stated = attributes.get(name, "auto")
    if stated not in ("true", "false", "auto"):
        raise context.error(element, f"{name}={shown(stated)} must be true, false or auto")
    if stated != "auto":
        return stated == "true"
    text = attributes.get(bounds)
    if text is None:
        return False
    if not context.compiler.auto_limits:
        raise context.error(element, f'with autolimits="false", {bounds} needs {name}')
    lower, upper = context.bounds(element, bounds, text)
    return lower < upper


def _effort(bounds: tuple[float, float]) -> float:
    """The bound of actuators' forces on the joint in the description; 0 for none."""
    lower, upper = bounds
    return 0.0 if (lower, upper) == (-inf, inf) else max(-lower, upper)


def actuator_range(scope: Scope, element: Element, attributes: Attributes) -> tuple[float, float]:
    """The bounds of the sum of actuators' forces on a joint or tendon."""
    if not is_limited(scope, element, attributes, "actuatorfrclimited", "actuatorfrcrange"):
        return (-inf, inf)
    text = attributes.get("actuatorfrcrange", "")
    lower, upper = scope.context.bounds(element, "actuatorfrcrange", text)
    if lower >= upper:
        raise scope.context.error(element, f"actuatorfrcrange={shown(text)}: the first number must be less")
    return lower, upper


def first_number(
    scope: Scope, element: Element, attributes: Attributes, name: str, *, may_drive: bool = False
) -> float:
    """The first number of an attribute; others are coefficients of higher powers.

    It is negative only if it `may_drive` what it acts on, as damping may.
    """
    text = attributes.get(name)
    if text is None:
        return 0.0
    numbers = scope.context.numbers(element, name, text, 1, 100)
    if any(numbers[1:]):
        scope.context.leave_out(element, "only the linear term counts", "polynomials are not built", name)
    if numbers[0] < 0.0 and not may_drive:
        raise scope.context.error(element, f"{name}={shown(text)} must not be negative")
    return numbers[0]
