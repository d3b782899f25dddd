"""Changes of the bodies and constraints of a world: each is made completely or not at all.

An exception may occur at any line: from a signal handler, or for lack of memory. The steps recorded in
`World.undo` then undo the change or complete it.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from typing import TYPE_CHECKING

from carom.description.pose import Pose
from carom.description.transform import compose
from carom.model.body_spec import BodySpec
from carom.native.undo import Undo
from carom.native.uninterrupted import uninterrupted
from carom.scene.body import Body
from carom.scene.dynamics_changes import change_base_freedom, set_base_freedom
from carom.scene.pattern import pattern_of
from carom.scene.soft_body import SoftBody
from carom.scene.undoing import begin
from carom.scene.user_constraints import UserConstraint

if TYPE_CHECKING:
    from carom.world.world import World


def note_additions(world: World, undo: Undo) -> None:
    """Record how to remove all bodies and constraints that are added from now on."""
    for part in (
        world.arrays,
        world.contact_arrays.shapes,
        world.contact_arrays.soft,
        world.constraints,
        world.user_constraints,
        world.user_data,
    ):
        undo.note(part.way_back())
    count, free_ids, next_id = len(world.bodies), world.free_ids, world.next_id
    links_loaded = world.links_loaded

    def forget() -> None:
        while len(world.bodies) > count:
            world.listing.pop(world.bodies.popitem()[0], None)
        world.free_ids, world.next_id = free_ids, next_id
        world.links_loaded = links_loaded

    undo.note(forget)


def add_bodies(
    world: World,
    bodies: Sequence[tuple[BodySpec, Pose]],
    also: Callable[[list[Body]], None] | None = None,
) -> list[Body]:
    """Add bodies at rest, all or none; see `World.load_all`."""
    with begin(world) as undo:
        note_additions(world, undo)
        added = [append(world, spec, pose) for spec, pose in bodies]
        world.scene_changed()
        for body in added:
            body.update_link_poses()
        world.update_soft_poses()
        begin_to_measure(world, added)
        if also is not None:
            also(added)
        undo.done()
    return added


def begin_to_measure(world: World, bodies: list[Body]) -> None:
    """Check the sensors of bodies that were added, and switch on what they need."""
    if not any(body.spec.sensors for body in bodies):
        return
    from carom.scene.sensors.changes import check_sensor, switch_on

    for body in bodies:
        for spec in body.spec.sensors:
            check_sensor(world, body, spec)
    switch_on(world, bodies)


def append(world: World, spec: BodySpec, pose: Pose) -> Body:
    """Add a body within a change; its link poses are computed later."""
    base_pose = compose(pose, spec.base.inertial_frame)
    *free_ids, body_id = world.free_ids or [world.next_id]
    pattern = pattern_of(spec)
    if pattern is not None and pattern.rows is not None:
        rows = world.arrays.put(pattern.rows, base_pose)
        body = Body(world, body_id, spec, rows, pattern.outline)
        world.contact_arrays.shapes.put(pattern.rows, rows)
    else:
        rows = world.arrays.append(spec, base_pose)
        body = (Body if spec.soft is None else SoftBody)(world, body_id, spec, rows)
        world.contact_arrays.shapes.append(spec, rows, body.all_dynamics)
        if spec.soft is not None:
            world.contact_arrays.soft.append(spec.soft, rows)
    world.free_ids, world.next_id = free_ids, max(world.next_id, body_id + 1)
    body.links_before = world.links_loaded
    world.links_loaded += 1 + body.joint_count
    world.bodies[body_id] = world.listing[body_id] = body
    world.constraints.add_body(body)
    world.user_data.add_stated(body_id, spec)
    return body


def remove_body(world: World, body: Body) -> None:
    """Remove a body from a world, with everything that belongs to it."""
    with begin(world) as undo:
        later = [other for other in world.bodies.values() if other.rows.tree > body.rows.tree]
        free_ids = [*world.free_ids, body.id]
        *listed, last = world.listing
        if last != body.id:
            listed[listed.index(body.id)] = last
        listing = {number: world.bodies[number] for number in listed}
        steps = (
            world.constraints.removal(body),
            world.user_constraints.removal(body),
            world.user_data.removal(body.id),
            world.contact_arrays.removal(body.rows),
            world.contact_arrays.soft.removal(body.rows),
            world.arrays.removal(body.rows, [other.rows for other in later]),
        )

        def remove() -> None:
            world.bodies.pop(body.id, None)
            for step in steps:
                step()
            for other in later:
                other.relocate()
            world.free_ids = free_ids
            world.list_bodies(listing)
            world.scene_changed()

        undo.at_once(remove)


def tie(world: World, constraint: UserConstraint) -> UserConstraint:
    """Add a new user constraint, and return it."""
    users = world.user_constraints
    numbers = users.next_numbers

    def go_back() -> None:
        world.constraints.drop_last_user(constraint)
        users.take_back(constraint, numbers)
        world.constraints_changed()

    undo = world.undo
    with undo:
        undo.settle()
        undo.note(go_back)
        users.put(constraint)
        world.constraints.add_user(constraint)
        world.constraints_changed()
        undo.done()
    return constraint


def untie(world: World, constraint: UserConstraint) -> None:
    """Remove a user constraint."""
    with uninterrupted:
        world.undo.settle()
        remove_constraint = world.constraints.user_removal(constraint)

        def remove() -> None:
            world.user_constraints.discard(constraint.id)
            remove_constraint()
            world.constraints_changed()

        world.undo.at_once(remove)


def part(world: World, links: Sequence[int]) -> None:
    """Drop the contacts of links, by row: they may collide with others from now on."""
    with uninterrupted:
        world.undo.settle()
        world.undo.at_once(world.contact_arrays.parting(links))


def free_base(world: World, body: Body, *, free: bool) -> None:
    """Free the base of a body, or fix it in the world."""
    with begin(world) as undo:
        undo.note(world.constraints.way_back())
        undo.note(partial(set_base_freedom, world, body, free=not body.fixed_base))
        change_base_freedom(world, body, free=free)
        world.scene_changed()
        undo.done()
