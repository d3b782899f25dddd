"""Adding actuators to bodies."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from carom.description.actuator import Actuator
from carom.errors import DescriptionError
from carom.layouts.codes import ConstraintKind
from carom.model.actuator_rows import check_joint_ranges, insert_actuator, join_actuators, write_actuator
from carom.native.change import Change
from carom.native.gates import alone
from carom.scene.actuators.actuated_joint import actuated_joint, drives_joint
from carom.scene.handles import world_of
from carom.scene.joint_constraints import JointConstraint
from carom.scene.tendons.making import new_transmission

if TYPE_CHECKING:
    from carom.scene.core.body_core import BodyCore


@alone("world.call_lock")
def add_actuator(body: BodyCore, name: str, actuator: Actuator) -> None:
    """Add an actuator to a body, as `Body.add_actuator` does."""
    world, spec = world_of(body), actuator.spec(name)
    spec.check()
    if not name or any(other.name == name for other in body.spec.actuators):
        raise DescriptionError(f"actuator {name!r}: each one of a body needs a name of its own")
    check_joint_ranges((*body.spec.actuators, spec))
    number = len(body.spec.actuators)
    change = Change(world.change_scene)
    if drives_joint(spec):
        joint = actuated_joint(body, spec)
        made = JointConstraint(body, joint, ConstraintKind.ACTUATOR, actuator=number)
    else:
        transmission = new_transmission(body, number, spec)
        made = JointConstraint(body, transmission.parent_link, ConstraintKind.USER, user=transmission)
        world.user_constraints.put(change, transmission)
    row = insert_actuator(change, world.arrays, body.rows, [other.rows for other in world.bodies.values()])
    model, specs = change.arrays(world.arrays.model.numpy), (*body.spec.actuators, spec)
    write_actuator(model, row, spec)
    join_actuators(model, body.rows.first["actuator"], specs)
    change.set(body, "spec", replace(body.spec, actuators=specs))
    change.extend(world.joint_constraints.all, [made])
    change.drop(body.__dict__, "actuators")
    world.change_scene(change)
    change.commit()
