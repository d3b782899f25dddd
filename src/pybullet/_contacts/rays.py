"""Ray tests."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from carom.description.pose import Pose
from pybullet._calls.arguments import integer, real, vector3
from pybullet._calls.builtin import exported
from pybullet._calls.constants import MAX_RAY_INTERSECTION_BATCH_SIZE
from pybullet._calls.errors import fail
from pybullet._clients.clients import client_of

if TYPE_CHECKING:
    from carom.engine.queries.ray_cast import RayTuple
    from pybullet._clients.clients import Client

__all__ = ["rayTest", "rayTestBatch"]

_BASE = -1
_BAD_ITEM = "Items in the from/to positions need to be an [x,y,z] list of 3 floats/doubles"
_NO_POSITIONS = "rayFromPositions and rayToPositions must be not None."
_UNEQUAL = "Size of from_positions need to be equal to size of to_positions."
_TOO_MANY = "Number of rays exceed the maximum batch size."


@exported
def rayTest(
    rayFromPosition: Sequence[float],
    rayToPosition: Sequence[float],
    collisionFilterMask: int = -1,
    reportHitNumber: int = -1,
    physicsClientId: int = 0,
) -> tuple[RayTuple]:
    """Casts a ray; returns its first hit.

    Args:
        rayFromPosition: Its start in the world frame [m].
        rayToPosition: Its end.
        collisionFilterMask: Mask of the collision groups that are hit.
        reportHitNumber: n for the n-th hit along the ray, from 0; negative for the first.
        physicsClientId: The connection.

    Returns:
        A tuple of one (body, link, fraction of the ray, position, normal); body -1 and fraction 1 without a
        hit.

    Raises:
        pybullet.error: Not connected, or a position is not three finite numbers.

    Examples:
        >>> body, link, fraction, position, normal = p.rayTest([0.5, 0, 1], [0.5, 0, -1])[0]
        >>> body == cube, link, round(position[2], 3)
        (True, -1, 0.05)
    """
    client = client_of(physicsClientId)
    start = vector3(rayFromPosition, _BAD_ITEM, "rayFromPosition")
    end = vector3(rayToPosition, _BAD_ITEM, "rayToPosition")
    mask = integer(collisionFilterMask, "collisionFilterMask")
    number = integer(reportHitNumber, "reportHitNumber")
    with client.call_lock:
        hit = client.world.queries().ray_tuple(start, end, mask=mask, hit_number=max(number, 0))
    client.window.show_rays((start,), (end,), (hit,))
    return (hit,)


@exported
def rayTestBatch(
    rayFromPositions: Sequence[Sequence[float]],
    rayToPositions: Sequence[Sequence[float]],
    numThreads: int = 1,
    parentObjectUniqueId: int = -1,
    parentLinkIndex: int = -1,
    reportHitNumber: int = -1,
    collisionFilterMask: int = -1,
    fractionEpsilon: float = -1.0,
    physicsClientId: int = 0,
) -> tuple[RayTuple, ...]:
    """Casts many rays; returns their first hits.

    Args:
        rayFromPositions: Their starts [m], at most `MAX_RAY_INTERSECTION_BATCH_SIZE`.
        rayToPositions: Their ends.
        numThreads: Accepted; the rays are cast by one thread.
        parentObjectUniqueId: Body whose frame the positions are in; -1 for the world's.
        parentLinkIndex: Its link, -1 for the base: positions are in that link's inertial frame.
        reportHitNumber: n for the n-th hit along each ray, from 0; negative for the first.
        collisionFilterMask: Mask of the collision groups that are hit.
        fractionEpsilon: Hits on the same link within this fraction of the ray after another are ignored.
        physicsClientId: The connection.

    Returns:
        For each ray (body, link, fraction of the ray, position, normal) as `rayTest` gives it.

    Raises:
        pybullet.error: Not connected, positions are not lists of three finite numbers, their numbers
            differ, or there are too many.

    Examples:
        >>> hits = p.rayTestBatch([[0.5, 0, 1], [9, 9, 1]], [[0.5, 0, -1], [9, 9, 2]])
        >>> [hit[0] for hit in hits]
        [2, -1]
    """
    client = client_of(physicsClientId)
    if rayFromPositions is None or rayToPositions is None:
        fail(_NO_POSITIONS)
    from pybullet._contacts.ray_points import in_world, ray_points

    starts = ray_points(rayFromPositions, _BAD_ITEM, "rayFromPositions")
    ends = ray_points(rayToPositions, _BAD_ITEM, "rayToPositions")
    if len(starts) != len(ends):
        fail(_UNEQUAL, f"They are {len(starts)} and {len(ends)}.")
    if len(starts) > MAX_RAY_INTERSECTION_BATCH_SIZE:
        fail(_TOO_MANY, f"{len(starts)} are more than {MAX_RAY_INTERSECTION_BATCH_SIZE}.")
    integer(numThreads, "numThreads")
    number = integer(reportHitNumber, "reportHitNumber")
    mask = integer(collisionFilterMask, "collisionFilterMask")
    epsilon = real(fractionEpsilon, "fractionEpsilon")
    if not len(starts):
        return ()
    frame = _frame_of(
        client,
        integer(parentObjectUniqueId, "parentObjectUniqueId"),
        integer(parentLinkIndex, "parentLinkIndex"),
    )
    if frame is not None:
        starts, ends = in_world(starts, frame), in_world(ends, frame)
    with client.call_lock:
        hits = client.world.queries().ray_tuples(
            starts, ends, mask=mask, hit_number=max(number, 0), separation=max(epsilon, 0.0)
        )
    client.window.show_rays(starts, ends, hits)
    return hits


def _frame_of(client: Client, body_id: int, link: int) -> Pose | None:
    """The frame of the rays; None for the world frame, which is also used for unknown bodies.

    As in PyBullet it is the frame that `getLinkState` returns: after a step, that at the start of its last
    substep.
    """
    body = client.world.bodies.get(body_id)
    if body is None or not _BASE <= link < body.joint_count:
        return None
    return Pose(*client.bodies[body_id].inertial_frame(link))
