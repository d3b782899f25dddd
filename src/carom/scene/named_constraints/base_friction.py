"""Dry friction of free bodies: a constraint to the world that stops them, within a greatest force."""

from __future__ import annotations

from typing import TYPE_CHECKING

from carom.description.pose import IDENTITY
from carom.layouts.codes import UserConstraintKind
from carom.model.body_spec import BASE
from carom.scene.named_constraints.named_constraint import yield_as
from carom.scene.user_constraints import UserConstraint

if TYPE_CHECKING:
    from carom.description.compliance import Compliance
    from carom.scene.core.body_core import BodyCore


def new_base_friction(body: BodyCore, friction: float, compliance: Compliance) -> UserConstraint:
    """The friction of a free body whose base has the frame of its free joint, to be put into its world.

    Args:
        body: The body.
        friction: Greatest force along each axis of the world [N], and torque about each of the base [N m].
        compliance: How it yields.
    """
    made = body.world.user_constraints.new(
        UserConstraintKind.BASE_FRICTION, body, BASE, None, BASE, (0.0, 0.0, 0.0), IDENTITY, IDENTITY
    )
    made.range = (0.0, 0.0, friction, 0.0)
    yield_as(made, compliance)
    return made
