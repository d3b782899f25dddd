"""Bringing whole scenes into a world: files that hold several robots and say where they are."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from pybullet._arguments import integer, real, text
from pybullet._builtin import exported
from pybullet._clients import Client, client_of
from pybullet._constants import (
    MJCF_COLORS_FROM_FILE,
    URDF_IGNORE_COLLISION_SHAPES,
    URDF_IGNORE_VISUAL_SHAPES,
    URDF_MERGE_FIXED_LINKS,
    URDF_USE_IMPLICIT_CYLINDER,
)
from pybullet._errors import fail, logger
from pybullet._new_bodies import add_bodies, warn_of_coordinates
from pybullet._origins import FileLoad

if TYPE_CHECKING:
    from carom.formats.placed import PlacedRobot
    from carom.formats.search import AssetSearch
    from carom.model.body_spec import BodySpec

__all__ = ["loadMJCF", "loadSDF"]

_CANNOT_LOAD_SDF = "Cannot load SDF file."
_CANNOT_LOAD_MJCF = "Couldn't load .mjcf file."
_MOST_BODIES = 512
# What PyBullet does not do with MJCF files.
_NOT_FOR_MJCF = URDF_MERGE_FIXED_LINKS | URDF_IGNORE_VISUAL_SHAPES | URDF_IGNORE_COLLISION_SHAPES


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

    Examples:
        >>> bodies = p.loadSDF("kuka_iiwa/model.sdf")
        >>> [p.getNumJoints(body) for body in bodies]
        [7]
    """
    name = text(sdfFileName, "sdfFileName")
    maximal = integer(useMaximalCoordinates, "useMaximalCoordinates")
    scaling = real(globalScaling, "globalScaling")
    client = client_of(physicsClientId)
    warn_of_coordinates("loadSDF", maximal)

    def read(search: AssetSearch) -> list[PlacedRobot]:
        from carom.formats.sdf import read_sdf

        return read_sdf(Path(name), scale=scaling if scaling > 0.0 else 1.0, search=search)

    def build(placed: PlacedRobot) -> BodySpec:
        from carom.model.assemble import assemble

        return assemble(placed.robot, fixed_base=placed.fixed_base)

    load = FileLoad("loadSDF", {"globalScaling": scaling})
    return _load(client, read, build, _CANNOT_LOAD_SDF, load)


@exported
def loadMJCF(
    mjcfFileName: str, flags: int = -1, useMultiBody: int = -1, physicsClientId: int = 0
) -> tuple[int, ...]:
    """Loads the bodies of an MJCF file, where the file puts them.

    What PyBullet reads of such files is read its way: every joint has a link without mass of its own,
    geoms weigh 1000 kg/m³, joints have neither damping nor armature, a body without joints floats, and
    every geom of the world is a body. What PyBullet cannot read is read as MuJoCo means it: classes of
    defaults, ball joints, ellipsoids, all kinds of orientations, `<frame>` and `<include>`.

    Args:
        mjcfFileName: The file: as given, in `data` folders near the working directory, or in the
            directory of `setAdditionalSearchPath`.
        flags: `URDF_*` and `MJCF_COLORS_FROM_FILE`, added up; -1 for none.
        useMultiBody: Bodies always have reduced coordinates in Carom; 0 logs a warning.
        physicsClientId: The connection.

    Returns:
        The ids of the bodies, in the order of the file.

    Raises:
        pybullet.error: Not connected, or the file is missing or cannot be used (what follows PyBullet's
            text names file, line, element and reason). The world is then as it was.

    Examples:
        >>> bodies = p.loadMJCF("mjcf/inverted_pendulum.xml")
        >>> p.getBodyInfo(bodies[-1])[1].decode()
        'inverted pendulum'
    """
    name = text(mjcfFileName, "mjcfFileName")
    bits = max(0, integer(flags, "flags"))
    client = client_of(physicsClientId)
    if integer(useMultiBody, "useMultiBody") == 0:
        logger.warning("loadMJCF: useMultiBody=0 has no effect; bodies have reduced coordinates.")

    def read(search: AssetSearch) -> list[PlacedRobot]:
        from carom.formats.mjcf import read_mjcf

        return read_mjcf(
            Path(name),
            colours=bits & MJCF_COLORS_FROM_FILE != 0,
            implicit=bits & URDF_USE_IMPLICIT_CYLINDER != 0,
            search=search,
        )

    def build(placed: PlacedRobot) -> BodySpec:
        from carom.model.assemble import assemble
        from carom.model.flags import LoadFlags
        from carom.model.mjcf_inertia import set_mjcf_inertias

        loading = LoadFlags(bits & ~_NOT_FOR_MJCF | URDF_USE_IMPLICIT_CYLINDER)
        spec = assemble(placed.robot, flags=loading, compound_margin=0.0)
        set_mjcf_inertias(spec)
        return spec

    return _load(client, read, build, _CANNOT_LOAD_MJCF, FileLoad("loadMJCF", {"flags": bits}))


def _load(
    client: Client,
    read: Callable[[AssetSearch], list[PlacedRobot]],
    build: Callable[[PlacedRobot], BodySpec],
    problem: str,
    load: FileLoad,
) -> tuple[int, ...]:
    """Brings all robots of a file into the world of a client, or none."""
    from carom.errors import CaromError

    try:
        placed = read(client.search())
        if len(placed) > _MOST_BODIES:
            fail(f"SDF exceeds body capacity: {len(placed)} > {_MOST_BODIES}")
        specs = [build(robot) for robot in placed]
    except CaromError as error:
        fail(problem, str(error))
    bodies = [(spec, robot.pose) for spec, robot in zip(specs, placed, strict=True)]
    return add_bodies(client, bodies, problem, replace(load, count=len(bodies)))
