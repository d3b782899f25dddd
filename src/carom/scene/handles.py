"""Access to the world of a body, unless the body was removed: its rows may then belong to other bodies."""

from __future__ import annotations

from typing import TYPE_CHECKING

from carom.description.pose import Pose
from carom.description.transform import compose, inverse

if TYPE_CHECKING:
    from carom.scene.core.body_core import BodyCore
    from carom.scene.core.world_core import WorldCore


def world_of(body: BodyCore) -> WorldCore:
    """The world a body is in.

    Raises:
        ValueError: The body was removed from it, or the world was reset or left.
    """
    if body.world.bodies.get(body.id) is not body:
        raise ValueError(f"body {body.id} ({body.name!r}) is no longer in its world")
    return body.world


def present_inertial_frame(body: BodyCore, link: int) -> Pose:
    """World pose of a link's inertial frame for the present coordinates; -1 is the base."""
    world = world_of(body)
    # After a step these rows contain the poses at the start of its last substep.
    body.update_link_poses()
    x, y, z, qx, qy, qz, qw = world.link_pose[body.first_link + 1 + link].tolist()
    return Pose((x, y, z), (qx, qy, qz, qw))


def present_link_frame(body: BodyCore, link: int) -> Pose:
    """World pose of a link frame for the present coordinates; -1 is the base."""
    return compose(present_inertial_frame(body, link), inverse(body.link_inertial_frame(link)))
