"""Looks up bodies and joints for calls outside the fast path, with error messages."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from pybullet._calls.arguments import integer
from pybullet._calls.errors import fail, no_body, warn_once_here
from pybullet._clients.clients import Client, client_of

if TYPE_CHECKING:
    from carom.scene.body import Body
    from carom.scene.core.body_core import BodyCore
    from pybullet._access.body_access import BodyAccess

BASE = -1
"""Index of the base among the links."""

OUT_OF_RANGE = "Joint index out-of-range."


def no_joint(body: Body, index: int) -> str:
    """Error message: no such joint."""
    return f"Body {body.id} ({body.spec.name}) has {body.joint_count} joints, so there is no joint {index}."


def has_joint(body: Body, index: int) -> bool:
    """Whether a body has a joint of this index, which is also that of the link that it moves."""
    return 0 <= index < body.joint_count


def joint_of(body: Body, joint_index: Any) -> int:
    """The index of a joint of a body; raises `pybullet.error` if there is none."""
    index = integer(joint_index, "jointIndex")
    if not has_joint(body, index):
        fail(OUT_OF_RANGE, no_joint(body, index))
    return index


def body_of(client: Client, body_id: Any, problem: str) -> Body:
    """The body with an id; raises `pybullet.error` with the text `problem` if there is none."""
    body = client.body(body_id)
    if body is None:
        fail(problem, no_body(body_id))
    return body


def link_of(body: BodyCore, link_index: Any, name: str, problem: str) -> int:
    """The index of a link, -1 for the base; raises `pybullet.error` with `problem` if there is none."""
    link = integer(link_index, name)
    if not BASE <= link < body.joint_count:
        fail(problem, f"{name}: body {body.id} ({body.name}) has no link {link}.")
    return link


def link_or_warning(client: Client, body_id: Any, link_index: Any, function: str) -> tuple[Body, int] | None:
    """A body and the index of its link, -1 for the base; None if one does not exist.

    Each line of a script is warned of it once, because control loops make the same call in every step.
    """
    body, link = client.body(body_id), integer(link_index, "linkIndex")
    if body is None:
        warn_once_here(f"{function}: {no_body(body_id)}")
        return None
    if not BASE <= link < body.joint_count:
        warn_once_here(f"{function}: {no_joint(body, link)}")
        return None
    return body, link


def body_access(body_id: Any, physics_client_id: Any, problem: str, negative: str = "") -> BodyAccess:
    """Access to a body; `pybullet.error` with `problem`, or `negative` for negative ids, if there is none."""
    client = client_of(physics_client_id)
    number = integer(body_id, "bodyUniqueId")
    if client.world.bodies.get(number) is None:
        fail(negative if number < 0 and negative else problem, no_body(number))
    return client.bodies[number]


def joint_access(body_id: Any, joint_index: Any, physics_client_id: Any) -> tuple[BodyAccess, int]:
    """A body and the index of a joint, to set it; raises `pybullet.error` if there is none."""
    access = body_access(body_id, physics_client_id, OUT_OF_RANGE)
    return access, joint_of(access.body, joint_index)


def state_access(body_id: Any, joint_index: Any, physics_client_id: Any) -> tuple[BodyAccess, int]:
    """A body and the index of a joint, to read its state; raises `pybullet.error` if there is none."""
    access = body_access(
        body_id, physics_client_id, "getJointState failed.", "getJointState failed; invalid bodyUniqueId"
    )
    index = integer(joint_index, "jointIndex")
    if not has_joint(access.body, index):
        problem = "getJointState failed; invalid jointIndex" if index < 0 else "getJointState failed (2)."
        fail(problem, no_joint(access.body, index))
    return access, index
