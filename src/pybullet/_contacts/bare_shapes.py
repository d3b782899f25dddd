"""Nearest points of collision shapes without a body.

They are computed in a temporary world with the shape and copies of the other links, all fixed at their
present poses.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

from carom.description import Pose
from carom.description.pose import IDENTITY
from carom.description.transform import compose, inverse, quaternion_from_matrix, rotation_matrix
from carom.model.body_spec import BASE, BodySpec, LinkSpec
from carom.model.inertia import collision_margin
from pybullet._calls.arguments import integer
from pybullet._calls.errors import logger
from pybullet._calls.optional_vectors import optional_rotation, optional_vector3
from pybullet._clients.clients import Client

if TYPE_CHECKING:
    from carom.description.pose import Vector3

Place = tuple[int, int]
"""A body and one of its links."""

BARE_LINK = -2
"""Link index that is reported for a shape without a body."""


@dataclass(frozen=True, slots=True)
class Thing:
    """One side of a query, by its reported place: a fixed body with shapes, and its link frame's pose.

    `margin` is that of a link [m] if `collisionMargin` has changed it.
    """

    place: Place
    spec: BodySpec
    pose: Pose
    margin: float | None = None


def bare_shape(
    client: Client, number: Any, body_id: int, position: Any, orientation: Any, side: str
) -> Thing | None:
    """A collision shape at a pose [m]; None, with a warning, if there is no such shape.

    `body_id` is the body that is reported, and `side`, A or B, is for error messages: an unusable pose raises
    `pybullet.error`.
    """
    from carom.layouts.flags import LoadFlags

    problem = "getClosestPoints failed."
    name = f"collisionShape{side}"
    shape = client.shapes.collisions.get(integer(number, name))
    place = optional_vector3(position, problem, f"collisionShapePosition{side}") or IDENTITY.position
    turn = optional_rotation(orientation, problem, f"collisionShapeOrientation{side}") or IDENTITY.orientation
    turn = quaternion_from_matrix(rotation_matrix(turn))
    if shape is None:
        logger.warning("getClosestPoints: there is no %s %d.", name, number)
        return None
    link = LinkSpec("", collisions=shape.collisions, compound_margin=0.0)
    spec = BodySpec("", link, fixed_base=True, flags=LoadFlags.USE_IMPLICIT_CYLINDER)
    return Thing((body_id, BARE_LINK), spec, Pose(place, turn))


def links_of(client: Client, body_id: int, link: int) -> list[Thing]:
    """One link of a body where it is now, or with `BARE_LINK` all; none if there is no such body or link."""
    body = client.world.bodies.get(body_id)
    if body is None:
        return []
    things = []
    # After a step, `link_pose` alone is that of the start of its last substep.
    with client.world.present_poses():
        first = body.first_link
        poses = client.world.link_pose[first : first + 1 + body.joint_count].tolist()
    for index in range(-1, body.joint_count) if link == BARE_LINK else [link]:
        if not -1 <= index < body.joint_count:
            continue
        spec = body.link_spec(index)
        x, y, z, qx, qy, qz, qw = poses[1 + index]
        pose = compose(Pose((x, y, z), (qx, qy, qz, qw)), inverse(spec.inertial_frame))
        copy = replace(spec, parent=-1, visuals=())
        margin = body.dynamics(index).collision_margin
        things.append(
            Thing(
                (body.id, index),
                BodySpec("", copy, fixed_base=True, flags=body.spec.flags),
                pose,
                None if margin == collision_margin(spec) else margin,
            )
        )
    return things


def nearest_points(
    client: Client, first: list[Thing], second: list[Thing], reach: float
) -> list[tuple[Place, Place, Vector3, Vector3, Vector3, float]]:
    """The nearest points of pairs of shapes, one from each list, that are at most `reach` [m] apart.

    They are found in a world of the same class as the client's.

    Returns:
        As from `Queries.nearest`, but with the reported body and link instead of the row of a link.
    """
    from carom.engine.parameters import BULLET

    with type(client.world)(contact=BULLET) as world:
        places: dict[int, Place] = {}

        def rows(things: list[Thing]) -> tuple[int, ...]:
            added = []
            for thing in things:
                body = world.load(thing.spec, thing.pose.position, thing.pose.orientation)
                if thing.margin is not None:
                    body.change_dynamics(BASE, collision_margin=thing.margin)
                row = body.first_link
                places[row] = thing.place
                added.append(row)
            return tuple(added)

        sides = rows(first), rows(second)
        found = world.queries().nearest(*sides, reach)
        return [
            (places[a], places[b], on_a, on_b, normal, distance)
            for a, b, on_a, on_b, normal, distance in found
        ]
