"""Bodies that come into the world of a client: all of a call, or none."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from pybullet._clients import Client
from pybullet._errors import fail, logger
from pybullet._origins import FileLoad, Origin

if TYPE_CHECKING:
    from carom.description.pose import Pose
    from carom.model.body_spec import BodySpec


def warn_of_coordinates(function: str, use_maximal: int) -> None:
    """Logs that maximal coordinates, where they are asked for, are not what the bodies have."""
    if use_maximal > 0:
        logger.warning(
            "%s: useMaximalCoordinates=1 has no effect; bodies have reduced coordinates.", function
        )


def add_bodies(
    client: Client,
    bodies: Sequence[tuple[BodySpec, Pose]],
    problem: str,
    load: FileLoad | None = None,
) -> tuple[int, ...]:
    """Brings bodies into a world.

    Args:
        client: Whose world.
        bodies: What they are, and the pose of the link frame of their base.
        problem: PyBullet's text when one cannot be made.
        load: The call that loads them from a file, if one does.

    Returns:
        Their ids.

    Raises:
        pybullet.error: The file of a mesh cannot be used; the world is as before.
    """
    from carom.errors import CaromError

    try:
        if len(bodies) > 1:
            _make_shapes([spec for spec, _ in bodies])
        with client.lock:
            client.bodies.clear()
            ids = tuple(client.world.load(spec, pose.position, pose.orientation).id for spec, pose in bodies)
            if load is not None:
                client.origins.update({number: Origin(load, index) for index, number in enumerate(ids)})
            return ids
    except CaromError as reason:
        fail(problem, str(reason))


def _make_shapes(specs: Sequence[BodySpec]) -> None:
    """Makes what collision detection needs, and keeps for later, so that what is wrong comes out now."""
    from carom.model.flags import LoadFlags
    from carom.model.shape_pieces import shape_pieces

    for spec in specs:
        implicit = bool(spec.flags & LoadFlags.USE_IMPLICIT_CYLINDER)
        for link in (spec.base, *spec.links):
            for collision in link.collisions:
                shape_pieces(collision.geometry, implicit_cylinder=implicit)
