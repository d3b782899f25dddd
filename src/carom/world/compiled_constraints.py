"""Constraints of MJCF files between bodies made from them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from carom.description.pose import Pose
from carom.description.transform import compose
from carom.model.body_spec import BASE
from carom.scene.named_constraints.base_friction import new_base_friction
from carom.scene.named_constraints.connect import Connect, Weld, new_connection
from carom.scene.named_constraints.joint_coupling import JointCoupling, new_coupling
from carom.scene.named_constraints.named_constraint import yield_as
from carom.scene.tendons.coupling import TendonCoupling
from carom.world.file_tendons import add_tendons

if TYPE_CHECKING:
    from carom.formats.mjcf.compiled.model import CompiledModel
    from carom.scene.core.body_core import BodyCore
    from carom.scene.user_constraints import UserConstraint

WORLD = "world"
NamedConstraint = JointCoupling | Connect | TendonCoupling


def constrain(bodies: Sequence[BodyCore], model: CompiledModel, place: Pose) -> list[NamedConstraint]:
    """Make the constraints of a file, whose frame is at `place`; called while bodies are added."""
    made: list[NamedConstraint] = []
    joints = {link.joint_name: (body, i) for body in bodies for i, link in enumerate(body.spec.links)}
    for it in model.couplings:
        body, follower = joints[it.follower]
        other, leader = (None, None) if it.leader is None else joints[it.leader]
        constraint = new_coupling(body, follower, leader, it.coefficients, it.name, other)
        yield_as(constraint, it.compliance)
        _put(body, constraint, enabled=it.enabled)
        made.append(JointCoupling(constraint))
    links = {body.spec.link(i).name: (body, i) for body in bodies for i in range(BASE, len(body.spec.links))}
    for it in model.connections:
        first, second, fixed = (*links[it.first], it.first_frame), None, it.second_frame
        if it.second == WORLD:
            fixed = compose(place, it.second_frame)
        else:
            second = (*links[it.second], it.second_frame)
        constraint = new_connection(it.name, first, second, fixed, is_weld=it.is_weld)
        if it.is_weld:
            constraint.gear_ratio = it.torque_scale
        yield_as(constraint, it.compliance)
        _put(first[0], constraint, enabled=it.enabled)
        made.append(Weld(constraint) if it.is_weld else Connect(constraint))
    free = {body.name: body for body in bodies}
    for it in model.frictions:
        _put(free[it.body], new_base_friction(free[it.body], it.friction, it.compliance), enabled=True)
    if model.tendons or any(it.spec is not None and it.spec.site for it in model.actuators):
        made += add_tendons(bodies, model, place)
    return made


def _put(body: BodyCore, constraint: UserConstraint, *, enabled: bool) -> None:
    constraint.enabled = enabled
    body.world.add_constraint(constraint)
