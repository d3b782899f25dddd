"""Which joint of a body an actuator drives, and which controls it is given."""

from __future__ import annotations

from math import isfinite
from typing import TYPE_CHECKING

from carom.errors import DescriptionError
from carom.layouts.codes import DRIVEN, ActivationDynamics
from carom.model.link_dynamics import enforced_limits

if TYPE_CHECKING:
    from carom.description.actuator import ActuatorSpec
    from carom.scene.core.body_core import BodyCore


def drives_joint(spec: ActuatorSpec) -> bool:
    """Whether an actuator drives a joint, and not a tendon, a site or a link."""
    return not (spec.tendon or spec.site or spec.link)


def needs_transmission(spec: ActuatorSpec) -> bool:
    """Whether an actuator acts on a tendon or at a site, through a constraint of its own."""
    return bool(spec.tendon or spec.site)


def control_range(body: BodyCore, spec: ActuatorSpec) -> tuple[float, float]:
    """The controls that an actuator is usually given, for sliders and action spaces.

    They are those within its bounds if it has any, the lengths that the limits of its joint allow if it is a
    position servo, and those from -1 to 1 otherwise.
    """
    lower, upper = spec.control_range
    if isfinite(lower) and isfinite(upper):
        return lower, upper
    is_servo = spec.gain[0] != 0.0 and spec.gain[0] == -spec.bias[1]
    if is_servo and spec.joint and spec.dynamics is not ActivationDynamics.INTEGRATOR:
        ends = [spec.gear * limit for limit in _limits(body, spec.joint)]
        if all(map(isfinite, ends)) and ends[0] != ends[1]:
            return min(ends), max(ends)
    return -1.0, 1.0


def _limits(body: BodyCore, name: str) -> tuple[float, float]:
    joint = next(joint for joint, link in enumerate(body.spec.links) if link.joint_name == name)
    return enforced_limits(body.spec.links[joint], body.dynamics(joint))


def actuated_joint(body: BodyCore, spec: ActuatorSpec) -> int:
    """Index of the joint of an actuator.

    Raises:
        DescriptionError: There is no such joint, or it has not one degree of freedom.
    """
    for joint, link in enumerate(body.spec.links):
        if link.joint_name == spec.joint:
            if body.joint_types[joint] not in DRIVEN:
                raise DescriptionError(
                    f"actuator {spec.name!r}: joint {spec.joint!r} is {link.joint_type.value}; actuators are "
                    "built for revolute and prismatic joints only"
                )
            return joint
    known = ", ".join(repr(link.joint_name) for link in body.spec.links) or "none"
    raise DescriptionError(f"actuator {spec.name!r}: there is no joint {spec.joint!r}; there are {known}")
