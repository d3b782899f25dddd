"""Which joint of a body an actuator drives."""

from __future__ import annotations

from typing import TYPE_CHECKING

from carom.description.actuator import ActuatorSpec
from carom.errors import DescriptionError
from carom.layouts.codes import WITH_FRICTION

if TYPE_CHECKING:
    from carom.scene.body import Body


def drives_joint(spec: ActuatorSpec) -> bool:
    """Whether an actuator drives a joint, and not a tendon or a site."""
    return not spec.tendon and not spec.site


def actuated_joint(body: Body, spec: ActuatorSpec) -> int:
    """Index of the joint of an actuator.

    Raises:
        DescriptionError: There is no such joint, or it has not one degree of freedom.
    """
    for joint, link in enumerate(body.spec.links):
        if link.joint_name == spec.joint:
            if body.joint_types[joint] not in WITH_FRICTION:
                raise DescriptionError(
                    f"actuator {spec.name!r}: joint {spec.joint!r} is {link.joint_type.value}; actuators are "
                    "built for revolute and prismatic joints only"
                )
            return joint
    known = ", ".join(repr(link.joint_name) for link in body.spec.links) or "none"
    raise DescriptionError(f"actuator {spec.name!r}: there is no joint {spec.joint!r}; there are {known}")
