"""Adding actuators to bodies."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from carom.description.actuator import Actuator, ActuatorSpec
from carom.errors import DescriptionError
from carom.layouts.codes import WITH_FRICTION, ConstraintKind
from carom.model.actuator_rows import insert_actuator, write_actuator
from carom.scene.handles import world_of
from carom.scene.joint_constraints import JointConstraint

if TYPE_CHECKING:
    from carom.scene.body import Body


def joint_of(body: Body, spec: ActuatorSpec) -> int:
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


def add_actuator(body: Body, name: str, actuator: Actuator) -> None:
    """Add an actuator to a body, as `Body.add_actuator` does."""
    world, spec = world_of(body).bodies[body.id].world, actuator.spec(name)
    spec.check()
    if not name or any(other.name == name for other in body.spec.actuators):
        raise DescriptionError(f"actuator {name!r}: each one of a body needs a name of its own")
    joint = joint_of(body, spec)
    row = insert_actuator(world.arrays, body.rows, [other.rows for other in world.bodies.values()])
    write_actuator(world.arrays.model.numpy, row, spec)
    number = len(body.spec.actuators)
    body.spec = replace(body.spec, actuators=(*body.spec.actuators, spec))
    world.constraints.all.append(JointConstraint(body, joint, ConstraintKind.ACTUATOR, actuator=number))
    world.constraints.rows.forget()
    world.scene_changed()
