"""Constraints, anchors, filters and texts of a world file, put on bodies; what does not fit is refused."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import fields
from math import inf
from typing import TYPE_CHECKING, cast

from carom.description.tendon import WORLD, TendonSpec
from carom.layouts.codes import (
    BALLS,
    LIMIT_KIND,
    MOTOR_KIND,
    WITH_FRICTION,
    ConstraintKind,
    PathKind,
    UserConstraintKind,
)
from carom.model.body_spec import BASE
from carom.model.soft_spec import Anchor
from carom.native.change import Change
from carom.scene.actuators.actuated_joint import actuated_joint
from carom.scene.core.soft_core import SoftCore
from carom.scene.joint_constraints import JointConstraint
from carom.scene.user_constraints import UserConstraint
from carom.world_files.saved_world import NONE, SavedConstraint, SavedTie, SavedWorld, index_in

if TYPE_CHECKING:
    from carom.scene.core.body_core import BodyCore
    from carom.scene.core.world_core import WorldCore


def put_on_bodies(world: WorldCore, saved: SavedWorld, bodies: Mapping[int, BodyCore], alone: bool) -> None:
    """Give bodies their constraints, anchors, filters and texts, and constraints their order.

    Args:
        world: The world of the bodies.
        saved: What the file says.
        bodies: The bodies by their numbers in the file.
        alone: Nothing else is in the world, so that constraints keep their numbers.

    Raises:
        ValueError: Something does not fit.
    """
    ties = _make_ties(world, saved, bodies, alone)
    _make_anchors(world, saved, bodies, alone)
    _order_constraints(world, saved, bodies, ties)
    _set_filters(world, saved, bodies)
    for body in bodies.values():
        for datum in world.user_data.of_body(body.id).copy():
            world.user_data.remove(datum)
    for datum in saved.user_data:
        body = bodies[datum.body]
        world.user_data.add(body.id, datum.link, datum.shape, datum.key, datum.value)


def _check_link(body: BodyCore, link: int) -> None:
    if not BASE <= link < body.joint_count:
        raise ValueError(f"body {body.id} has no link {link}")


def _make_ties(
    world: WorldCore, saved: SavedWorld, bodies: Mapping[int, BodyCore], alone: bool
) -> dict[int, UserConstraint]:
    ties = {}
    for record in saved.ties:
        parent = bodies[record.parent]
        child = None if record.child == NONE else bodies[record.child]
        _check_link(parent, record.parent_link)
        _check_link(parent, record.gear_auxiliary_link)
        if child is not None:
            _check_link(child, record.child_link)
        _check_path(parent, record)
        values = {field.name: getattr(record, field.name) for field in fields(SavedTie)}
        values |= {"parent": parent, "child": child}
        if not alone:
            values["id"] = world.user_constraints.next_id
        elif record.id in ties or record.id < 1:
            raise ValueError(f"the number {record.id} of a constraint is used twice or out of range")
        ties[record.id] = UserConstraint(**values)
        change = Change()
        world.user_constraints.put(change, ties[record.id])
        change.commit()
    return ties


def _check_path(body: BodyCore, record: SavedTie) -> None:
    """Raise `ValueError` unless the path of a constraint is one, and its actuator exists."""
    if record.kind < UserConstraintKind.TENDON or record.kind is UserConstraintKind.BASE_FRICTION:
        return
    if record.kind is UserConstraintKind.TENDON:
        stiffness, damping, *rest = record.spring
        lower, upper, friction, _ = record.range
        bounds = (rest[0], rest[1]), (lower, upper)
        TendonSpec(
            record.name, record.path, stiffness, damping, *bounds, friction, armature=record.armature
        ).check()
    elif any(abs(number) == inf for number in record.range):
        raise ValueError("only tendons have bounds that may be infinite")
    for path in (record.path, *((record.second_path,) if record.second_path else ())):
        if not record.is_wrench:
            TendonSpec(record.name, path).check()
        elif len(path) != 1 or path[0].kind is not PathKind.SITE:
            raise ValueError("the transmission to a site needs one site")
    for part in (*record.path, *record.second_path):
        for link in (part.link, part.side_link):
            if link != WORLD:
                _check_link(body, link)
        if part.kind is PathKind.JOINT and (part.link < 0 or body.velocity_count[part.link] != 1):
            raise ValueError(f"link {part.link} of body {body.id} has no joint that a tendon could follow")
        if part.kind is PathKind.BALL and (part.link < 0 or body.joint_types[part.link] not in BALLS):
            raise ValueError(f"link {part.link} of body {body.id} has no spherical joint")
    if record.kind is UserConstraintKind.TRANSMISSION:
        index_in(record.actuator, list(body.spec.actuators))


def _make_anchors(world: WorldCore, saved: SavedWorld, bodies: Mapping[int, BodyCore], alone: bool) -> None:
    for record in saved.anchors:
        soft, body = bodies[record.soft], None if record.body == NONE else bodies[record.body]
        if not isinstance(soft, SoftCore) or not 0 <= record.node < soft.rows.count["node"]:
            raise ValueError(f"body {record.soft} has no node {record.node}")
        if body is not None and (body.spec.soft is not None or not BASE <= record.link < body.joint_count):
            raise ValueError(f"body {body.id} has no link {record.link} to which a node could be anchored")
        change = Change()
        number = record.id if alone else world.user_constraints.take_id(change)
        if number in world.contact_arrays.soft.anchors or number < 1:
            raise ValueError(f"the number {number} of an anchor is used twice or out of range")
        rows = None if body is None else body.rows
        anchor = Anchor(
            number, soft.soft_rows, record.node, rows, record.link, record.pivot,
            record.damped, record.late_force,
        )  # fmt: skip
        change.put(world.contact_arrays.soft.anchors, number, anchor)
        change.commit()


def _order_constraints(
    world: WorldCore, saved: SavedWorld, bodies: Mapping[int, BodyCore], ties: dict[int, UserConstraint]
) -> None:
    """Restore the order of constraints and of objects, from which the solver's order follows."""
    ours = {id(body) for body in bodies.values()}
    own = [constraint for constraint in world.joint_constraints.all if id(constraint.body) not in ours]
    used = set()
    for record in saved.constraints:
        body = bodies[record.body]
        tie = None if record.user == NONE else ties[record.user]
        if not _fits(record, body, tie):
            raise ValueError("a constraint does not fit its joint")
        if tie is not None:
            used.add(record.user)
        limits = record.lower, record.upper, record.twist
        rest = tie, record.max_impulse, record.actuator
        own.append(JointConstraint(body, record.joint, record.kind, *limits, *rest))
        own[-1].yield_as_described()
    if used != ties.keys():
        raise ValueError("a constraint is missing")
    world.joint_constraints.all = own
    tags = world.joint_constraints.tags
    others = [link for link in tags.links if world.bodies[cast(int, link[0])] not in bodies.values()]
    objects = [(bodies[body].id, link) for body, link in saved.objects]
    count = sum(1 + body.joint_count for body in bodies.values())
    if not len(set(objects)) == len(objects) == count:
        raise ValueError("the list of objects does not contain every link exactly once")
    tags.reorder([*others, *objects])


def _fits(record: SavedConstraint, body: BodyCore, tie: UserConstraint | None) -> bool:
    """Whether the kind of a constraint is one that its joint, or its user constraint, can have."""
    if tie is not None:
        kind_and_place = (ConstraintKind.USER, tie.parent, tie.parent_link)
        return (record.kind, body, record.joint) == kind_and_place
    joint = body.joint_types[index_in(record.joint, body.spec.links)]
    if record.kind == ConstraintKind.ACTUATOR:
        actuator = body.spec.actuators[index_in(record.actuator, list(body.spec.actuators))]
        return record.joint == actuated_joint(body, actuator)
    friction = ConstraintKind.FRICTION if joint in WITH_FRICTION else None
    return record.kind in (MOTOR_KIND.get(joint), LIMIT_KIND.get(joint), friction)


def _set_filters(world: WorldCore, saved: SavedWorld, bodies: Mapping[int, BodyCore]) -> None:
    for it in saved.filters:
        rows = []
        for body, link in ((bodies[it.body_a], it.link_a), (bodies[it.body_b], it.link_b)):
            _check_link(body, link)
            rows.append(body.first_link + 1 + link)
        world.contact_arrays.shapes.filters.set(*rows, enabled=it.enabled, contact=it.contact)
