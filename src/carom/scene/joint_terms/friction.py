"""Dry friction of joints: what can be read and set during the simulation."""

from __future__ import annotations

from typing import TYPE_CHECKING

from carom.layouts.codes import WITH_FRICTION, ConstraintKind
from carom.native.change import Change
from carom.native.gates import gated
from carom.scene.joint_constraints import JointConstraint

if TYPE_CHECKING:
    from carom.scene.core.body_core import BodyCore


def friction_of(body: BodyCore, joint: int) -> JointConstraint | None:
    """The friction of a joint, if it ever had some."""
    for constraint in body.world.joint_constraints.all:
        if (
            constraint.body is body
            and constraint.joint == joint
            and constraint.kind == ConstraintKind.FRICTION
        ):
            return constraint
    return None


@gated("world.call_lock")
def set_friction(body: BodyCore, joint: int, friction: float) -> None:
    """Set the friction of a joint [N m or N]; of a spherical one, that about each axis of the link.

    Raises:
        ValueError: It is negative, or the joint is not revolute, prismatic or spherical.
    """
    if not 0.0 <= friction < float("inf"):
        raise ValueError(f"friction_loss is {friction}: it must be at least 0 and finite")
    if body.joint_types[joint] not in WITH_FRICTION:
        link = body.spec.links[joint]
        raise ValueError(
            f"joint {link.joint_name!r} is {link.joint_type.value}: friction is not built for such joints"
        )
    change, constraint = Change(), friction_of(body, joint)
    if constraint is not None:
        change.set(constraint, "upper", friction)
    elif friction > 0.0:
        made = JointConstraint(body, joint, ConstraintKind.FRICTION, upper=friction)
        change.extend(body.world.joint_constraints.all, [made])
    else:
        return
    body.world.change_scene(change)
    change.commit()
