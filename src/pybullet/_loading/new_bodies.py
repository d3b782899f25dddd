"""Adding bodies to the world of a client: all bodies of a call, or none."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import cache
from typing import TYPE_CHECKING

from carom import description
from carom.errors import CaromError
from pybullet._calls.errors import fail, logger
from pybullet._clients.clients import Client
from pybullet._clients.origins import FileLoad, Origin

if TYPE_CHECKING:
    from carom.description.pose import Pose
    from carom.model.body_spec import BodySpec
    from carom.native.change import Change
    from carom.scene.body import Body


def warn_of_coordinates(
    function: str, use_maximal: int, client: Client, argument: str = "useMaximalCoordinates=1"
) -> None:
    """Log a warning if a script asks for maximal coordinates, which Carom does not support."""
    if use_maximal > 0 and client.deformable:
        logger.warning(
            "%s: %s only takes away the damping by air and makes external forces act twice, as in PyBullet's "
            "deformable world; bodies have reduced coordinates.",
            function,
            argument,
        )
    elif use_maximal > 0:
        logger.warning(
            "%s: %s only takes away the damping by air; bodies have reduced coordinates.", function, argument
        )


def keep_flags_of_colours(client: Client, flags: int) -> None:
    """Note which colours a file was loaded with: what comes without flags of its own gets them, too."""
    client.flags_of_colours = flags & _colours()


def with_flags_of_colours(client: Client, flags: int) -> int:
    """Flags whose bits about colours are those of the last `loadURDF`, as in PyBullet.

    `loadSDF` clears them.
    """
    return (flags & ~_colours()) | client.flags_of_colours


@cache
def _colours() -> int:
    """The flags about colours."""
    from carom.layouts.flags import LoadFlags

    return int(LoadFlags.COLOURS)


def add_bodies(
    client: Client,
    bodies: Sequence[tuple[BodySpec, Pose]],
    problem: str,
    load: FileLoad | None = None,
    *,
    maximal: bool = False,
) -> tuple[int, ...]:
    """Add bodies to the world of a client, each with the pose of its base's link frame; returns their ids.

    `load` is the call that loads them from a file; `maximal` says whether the script asked for maximal
    coordinates: air does not slow such bodies, and files that PyBullet wrote keep them apart. If the file of
    a mesh cannot be used, `pybullet.error` is raised, with `problem` first, and the world is unchanged.
    """
    if maximal:
        bodies = [(replace(spec, link_damping=0.0), pose) for spec, pose in bodies]
    try:
        with client.call_lock:
            client.bodies.forget_all()

            def note(change: Change, added: list[Body]) -> None:
                for index, body in enumerate(added):
                    if load is not None:
                        change.put(client.origins, body.id, Origin(load, index))
                    elif body.id in client.origins:
                        change.drop(client.origins, body.id)
                ids = {body.id for body in added}
                if maximal:
                    change.set(client, "maximal", client.maximal | ids)
                elif not client.maximal.isdisjoint(ids):
                    change.set(client, "maximal", client.maximal - ids)
                _look_at_fresh_files(client, added)

            return tuple(body.id for body in client.world.load_all(bodies, note=note))
    except CaromError as reason:
        fail(problem, str(reason))


def _look_at_fresh_files(client: Client, bodies: Sequence[Body]) -> None:
    """Read the files of visual shapes now if they may be deleted before the first image.

    Otherwise the first image reads them, because they are larger than a robot's other files.
    """
    from carom.files.bounded import is_fresh

    paths = {
        visual.geometry.path
        for body in bodies
        for link in (body.spec.base, *body.spec.links)
        for visual in link.visuals
        if isinstance(visual.geometry, description.Mesh)
    }
    if any(map(is_fresh, paths)):
        from carom.render.appearance import appearance_of

        appearance = appearance_of(client.world)
        appearance.number_textures([*client.world.bodies.values(), *bodies])
