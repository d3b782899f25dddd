"""Changes of the bodies and constraints of a world: each is prepared beside it, and then made by one call.

Rows of new bodies are written where nobody looks yet, behind those in use.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

from carom.description.pose import Pose
from carom.description.transform import compose
from carom.model.body_spec import BodySpec
from carom.native.change import Change
from carom.native.gates import gated
from carom.native.uninterrupted import uninterrupted
from carom.scene.body import Body
from carom.scene.dynamics.changes import change_base_freedom
from carom.scene.pattern import pattern_of

if TYPE_CHECKING:
    from carom.scene.core.body_core import BodyCore
    from carom.scene.core.world_core import WorldCore


@gated("call_lock")
def add_bodies(
    world: WorldCore,
    bodies: Sequence[tuple[BodySpec, Pose]],
    also: Callable[[list[Body]], None] | None = None,
    note: Callable[[Change, list[Body]], None] | None = None,
) -> list[Body]:
    """Add bodies at rest, all or none; see `World.load_all`."""
    world.refuse_if_left()
    with uninterrupted:
        if also is not None or any(spec.soft is not None or spec.sensors for spec, _ in bodies):
            return _add_to_draft(world, bodies, also, note)
        change = Change(world.change_scene)
        try:
            added = [append(change, world, spec, pose) for spec, pose in bodies]
            update = world.prepare_poses()
            for body in added:
                update(body.rows.tree)
            if note is not None:
                note(change, added)
            world.change_scene(change)
        except BaseException:
            world.arrays.clear_unused()
            world.contact_arrays.shapes.clear_unused()
            raise
        change.commit()
    return added


def _add_to_draft(
    world: WorldCore,
    bodies: Sequence[tuple[BodySpec, Pose]],
    also: Callable[[list[Body]], None] | None,
    note: Callable[[Change, list[Body]], None] | None,
) -> list[Body]:
    """Add bodies to a draft of a world, where they can be changed as any others before the world has them."""
    from carom.scene.draft import draft_of

    draft = draft_of(world)
    added = [append_now(draft.world, spec, pose) for spec, pose in bodies]
    for body in added:
        body.update_link_poses()
    draft.world.update_soft_poses()
    if also is not None:
        also(added)
    draft.measure(added)
    change = Change()
    if note is not None:
        note(change, added)
    draft.publish(change)
    return added


def append(change: Change, world: WorldCore, spec: BodySpec, pose: Pose) -> Body:
    """Add a body, which is not soft, with a change; its link poses are computed later."""
    base_pose = compose(pose, spec.base.inertial_frame)
    *free_ids, body_id = change.get(world, "free_ids") or [change.get(world, "next_id")]
    shapes = world.contact_arrays.shapes
    pattern = pattern_of(spec)
    if pattern is not None and pattern.rows is not None:
        rows = world.arrays.put(change, pattern.rows, base_pose)
        body = Body(world, body_id, spec, rows, pattern.outline)
        shapes.put(change, pattern.rows, rows)
    else:
        rows = world.arrays.append(change, spec, base_pose)
        body = _body_class(spec)(world, body_id, spec, rows)
        shapes.append(change, spec, rows, body.all_dynamics)
    change.set(world, "free_ids", free_ids)
    change.set(world, "next_id", max(change.get(world, "next_id"), body_id + 1))
    body.links_before = change.get(world, "links_loaded")
    change.set(world, "links_loaded", body.links_before + 1 + body.joint_count)
    change.put(world.bodies, body_id, body)
    change.put(world.listing, body_id, body)
    world.joint_constraints.add_body(change, body)
    world.user_data.add_stated(change, body_id, spec)
    return body


def _body_class(spec: BodySpec) -> type[Body]:
    if spec.soft is None:
        return Body
    from carom.scene.soft_body import SoftBody

    return SoftBody


def append_now(world: WorldCore, spec: BodySpec, pose: Pose) -> Body:
    """Add a body to a draft of a world, at once; its link poses are computed later."""
    change = Change(world.change_scene)
    body = append(change, world, spec, pose)
    world.change_scene(change)
    change.commit()
    if spec.soft is not None:
        world.contact_arrays.soft.append(spec.soft, body.rows)
        world.scene_changed()
    return body


@gated("call_lock")
def remove_body(world: WorldCore, body: BodyCore) -> None:
    """Remove a body from a world, with everything that belongs to it."""
    with uninterrupted:
        later = [other for other in world.bodies.values() if other.rows.tree > body.rows.tree]
        *listed, last = world.listing
        if last != body.id:
            listed[listed.index(body.id)] = last
        change = Change()
        world.joint_constraints.remove(change, body)
        world.user_constraints.remove(change, body)
        world.user_data.remove_all(change, body.id)
        world.contact_arrays.remove(change, body.rows)
        world.contact_arrays.soft.remove(change, body.rows)
        firsts = world.arrays.remove(change, body.rows, [other.rows for other in later])
        for other, first in zip(later, firsts, strict=True):
            other.relocate(change, first)
        change.drop(world.bodies, body.id)
        change.refill(world.listing, {number: world.bodies[number] for number in listed})
        change.set(world, "free_ids", [*world.free_ids, body.id])
        world.change_scene(change)
        change.commit()
        body.forget_handles()


@gated("call_lock")
def free_base(world: WorldCore, body: BodyCore, *, free: bool) -> None:
    """Free the base of a body, or fix it in the world."""
    with uninterrupted:
        change = Change()
        change_base_freedom(change, body, free=free)
        world.change_scene(change)
        change.commit()
