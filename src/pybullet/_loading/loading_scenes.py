"""Loading scenes into a world: files with several robots and their poses."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

from carom.errors import CaromError
from pybullet._calls.arguments import integer, moderate, real, text
from pybullet._calls.builtin import exported
from pybullet._calls.errors import fail
from pybullet._clients.clients import Client, client_of
from pybullet._clients.origins import FileLoad
from pybullet._loading.new_bodies import (
    add_bodies,
    keep_flags_of_colours,
    warn_of_coordinates,
    with_flags_of_colours,
)

if TYPE_CHECKING:
    from carom.file_bodies import PlacedBody
    from carom.formats.search import AssetSearch

__all__ = ["loadMJCF", "loadSDF"]

_CANNOT_LOAD_SDF = "Cannot load SDF file."
_CANNOT_LOAD_MJCF = "Couldn't load .mjcf file."
_MAX_BODIES = 512


@exported
def loadSDF(
    sdfFileName: str, useMaximalCoordinates: int = -1, globalScaling: float = -1, physicsClientId: int = 0
) -> tuple[int, ...]:
    """Loads the models of an SDF file, at the poses that the file gives them.

    As in PyBullet, inertias are computed from collision shapes, the pose of a model is that of its root link,
    only `<static>1</static>` makes a model static, joints are at the origins of their child links, and nested
    models are ignored. Unlike in PyBullet, files named by `<include>` are loaded too.

    Args:
        sdfFileName: The file: as given, in `data` folders near the working directory, or in the
            directory of `setAdditionalSearchPath`.
        useMaximalCoordinates: Bodies always have reduced coordinates in Carom; 1 logs a warning. As in
            PyBullet, air does not slow such bodies, and in deformable worlds external forces act twice.
        globalScaling: Factor on lengths, 1 when not greater than 0. As in PyBullet, it does not apply to
            radii of spheres and to joint limits.
        physicsClientId: The connection.

    Returns:
        The ids of the bodies, in the order of the file.

    Raises:
        pybullet.error: Not connected, or the file is missing or cannot be used (after PyBullet's text the
            message names file, line, element and reason). The world is then unchanged.

    Examples:
        >>> bodies = p.loadSDF("kuka_iiwa/model.sdf")
        >>> [p.getNumJoints(body) for body in bodies]
        [7]
    """
    name = text(sdfFileName, "sdfFileName")
    maximal = integer(useMaximalCoordinates, "useMaximalCoordinates")
    scaling = real(globalScaling, "globalScaling")
    if scaling > 0.0:
        moderate(scaling, _CANNOT_LOAD_SDF, "globalScaling")
    client = client_of(physicsClientId)
    warn_of_coordinates("loadSDF", maximal, client)

    def read(search: AssetSearch) -> list[PlacedBody]:
        from carom.file_bodies import sdf_bodies

        scale = scaling if scaling > 0.0 else 1.0
        return sdf_bodies(Path(name), search, scale=scale, words_are_true=False)

    load = FileLoad("loadSDF", {"globalScaling": scaling})
    bodies = _load(client, read, _CANNOT_LOAD_SDF, load, maximal=maximal > 0)
    keep_flags_of_colours(client, 0)
    return bodies


@exported
def loadMJCF(
    mjcfFileName: str, flags: int = -1, useMultiBody: int = -1, physicsClientId: int = 0
) -> tuple[int, ...]:
    """Loads the bodies of an MJCF file, at the poses that the file gives them.

    Elements that PyBullet supports have the same meaning as in PyBullet: every joint has a link of its own
    without mass, geoms have a density of 1000 kg/m³, joints have neither damping nor armature, a body without
    joints floats, every geom of the world is a body, `axisangle` rotates geoms but not bodies, and named
    default classes do not limit joints. Other elements have the same meaning as in MuJoCo: other attributes
    of such classes, ball joints, ellipsoids, all kinds of orientations, `<frame>` and `<include>`.

    Args:
        mjcfFileName: The file: as given, in `data` folders near the working directory, or in the
            directory of `setAdditionalSearchPath`.
        flags: `URDF_*` and `MJCF_COLORS_FROM_FILE`, added up; -1 for none.
        useMultiBody: Bodies always have reduced coordinates in Carom; 0 logs a warning. In deformable worlds
            it makes external forces act twice, as in PyBullet.
        physicsClientId: The connection.

    Returns:
        The ids of the bodies, in the order of the file.

    Raises:
        pybullet.error: Not connected, or the file is missing or cannot be used (after PyBullet's text the
            message names file, line, element and reason). The world is then unchanged.

    Examples:
        >>> bodies = p.loadMJCF("mjcf/inverted_pendulum.xml")
        >>> p.getBodyInfo(bodies[-1])[1].decode()
        'inverted pendulum'
    """
    name = text(mjcfFileName, "mjcfFileName")
    bits = max(0, integer(flags, "flags"))
    client = client_of(physicsClientId)
    maximal = integer(useMultiBody, "useMultiBody") == 0
    warn_of_coordinates("loadMJCF", int(maximal), client, "useMultiBody=0")

    def read(search: AssetSearch) -> list[PlacedBody]:
        from carom.file_bodies import mjcf_bodies

        return mjcf_bodies(Path(name), search, flags=with_flags_of_colours(client, bits), as_mujoco=False)

    load = FileLoad("loadMJCF", {"flags": bits})
    return _load(client, read, _CANNOT_LOAD_MJCF, load, maximal=maximal)


def _load(
    client: Client,
    read: Callable[[AssetSearch], list[PlacedBody]],
    problem: str,
    load: FileLoad,
    *,
    maximal: bool,
) -> tuple[int, ...]:
    """Load all bodies of a file into the world of a client, or none if there is an error."""
    try:
        bodies = read(client.search())
    except CaromError as error:
        fail(problem, str(error))
    if len(bodies) > _MAX_BODIES:
        fail(f"SDF exceeds body capacity: {len(bodies)} > {_MAX_BODIES}")
    counted = FileLoad(load.function, load.arguments, load.takes_pose, len(bodies))
    return add_bodies(client, bodies, problem, counted, maximal=maximal)
