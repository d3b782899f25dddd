"""Bringing whole scenes into a world: files that hold several robots and say where they are."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

from pybullet._arguments import integer, real, text
from pybullet._builtin import exported
from pybullet._clients import Client, client_of
from pybullet._errors import fail, logger

if TYPE_CHECKING:
    from carom.formats.placed import PlacedRobot
    from carom.formats.search import AssetSearch

__all__ = ["loadSDF"]

_CANNOT_LOAD = "Cannot load SDF file."
_MOST_BODIES = 512


@exported
def loadSDF(
    sdfFileName: str, useMaximalCoordinates: int = -1, globalScaling: float = -1, physicsClientId: int = 0
) -> tuple[int, ...]:
    """Loads the models of an SDF file, where the file puts them.

    As in PyBullet inertias come from collision shapes, the pose of a model is that of its root link,
    `<static>` counts when it says 1, joints are at the origins of their children, and models inside of
    models are left out. Unlike there, files named by `<include>` are loaded too.

    Args:
        sdfFileName: The file: as given, in `data` folders near the working directory, or in the
            directory of `setAdditionalSearchPath`.
        useMaximalCoordinates: Bodies always have reduced coordinates in Carom; 1 logs a warning.
        globalScaling: Factor on lengths, 1 when not greater than 0. As in PyBullet balls and limits of
            joints keep their size.
        physicsClientId: The connection.

    Returns:
        The ids of the bodies, in the order of the file.

    Raises:
        pybullet.error: Not connected, or the file is missing or cannot be used (what follows PyBullet's
            text names file, line, element and reason). The world is then as it was.
    """
    name = text(sdfFileName, "sdfFileName")
    maximal = integer(useMaximalCoordinates, "useMaximalCoordinates")
    scaling = real(globalScaling, "globalScaling")
    client = client_of(physicsClientId)
    if maximal > 0:
        logger.warning("loadSDF: useMaximalCoordinates=1 has no effect; bodies have reduced coordinates.")

    def read(search: AssetSearch) -> list[PlacedRobot]:
        from carom.formats.sdf import read_sdf

        return read_sdf(Path(name), scale=scaling if scaling > 0.0 else 1.0, search=search)

    return _load(client, read, 0, _CANNOT_LOAD)


def _load(
    client: Client, read: Callable[[AssetSearch], list[PlacedRobot]], flags: int, problem: str
) -> tuple[int, ...]:
    """Brings all robots of a file into the world of a client, or none."""
    from carom.errors import CaromError
    from carom.formats.search import AssetSearch
    from carom.model.assemble import assemble
    from carom.model.flags import LoadFlags

    try:
        placed = read(AssetSearch(client.search_path))
        if len(placed) > _MOST_BODIES:
            fail(f"SDF exceeds body capacity: {len(placed)} > {_MOST_BODIES}")
        specs = [
            assemble(robot.robot, flags=LoadFlags(flags), fixed_base=robot.fixed_base) for robot in placed
        ]
    except CaromError as error:
        fail(problem, str(error))
    with client.lock:
        client.bodies.clear()
        return tuple(
            client.world.load(spec, robot.pose.position, robot.pose.orientation).id
            for spec, robot in zip(specs, placed, strict=True)
        )
