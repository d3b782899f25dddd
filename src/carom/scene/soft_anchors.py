"""Anchors of soft bodies: nodes held by the world or by links."""

from __future__ import annotations

from typing import TYPE_CHECKING

from carom.description.pose import Pose
from carom.description.transform import compose, inverse
from carom.model.soft_spec import Anchor
from carom.native.change import Change
from carom.native.gates import alone
from carom.native.uninterrupted import uninterrupted

if TYPE_CHECKING:
    from carom.scene.body import Body
    from carom.scene.soft_body import SoftBody
    from carom.world.world import World


@alone("world.lock")
def add_anchor(
    soft: SoftBody, node: int, body: Body | None, link: int, damped: bool, late_force: float
) -> Anchor:
    """Anchor a node; see `SoftBody.anchor`."""
    world = soft.world
    if not 0 <= node < len(soft.nodes):
        raise IndexError(f"body {soft.id} has {len(soft.nodes)} nodes; there is no node {node}")
    pivot = (0.0, 0.0, 0.0)
    if body is not None:
        if not -1 <= link < body.joint_count:
            raise IndexError(f"body {body.id} has {body.joint_count} links; there is no link {link}")
        if body.spec.soft is not None:
            raise ValueError(f"body {body.id} is soft: only the world and rigid bodies hold nodes")
        px, py, pz, *turn = world.link_pose[body.first_link + 1 + link].tolist()
        x, y, z = soft.nodes[node].tolist()
        qx, qy, qz, qw = turn
        local = compose(inverse(Pose((px, py, pz), (qx, qy, qz, qw))), Pose((x, y, z)))
        pivot = local.position
    with uninterrupted:
        change = Change(world.change_scene)
        number = world.user_constraints.take_id(change)
        rows = None if body is None else body.rows
        anchor = Anchor(number, soft.soft_rows, node, rows, link, pivot, damped, late_force)
        change.put(world.contact_arrays.soft.anchors, number, anchor)
        if body is None:
            change.write(soft.node_velocities[node], 0.0)
        _commit(change, world)
    return anchor


@alone("lock")
def remove_anchor(world: World, number: int) -> None:
    """Remove the anchor with a number, if it exists."""
    with uninterrupted:
        change = Change(world.change_scene)
        change.drop(world.contact_arrays.soft.anchors, number)
        _commit(change, world)


def _commit(change: Change, world: World) -> None:
    """Make a change of anchors, and update what depends on them with it."""
    world.contact_arrays.soft.note_anchors(change)
    world.note_soft_poses(change)
    world.change_scene(change)
    change.commit()
