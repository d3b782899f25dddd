"""Loading robots into a world."""

from __future__ import annotations

from pathlib import Path
from typing import Any, overload

from carom.description.pose import Pose
from carom.errors import CaromError
from pybullet._calls.arguments import Vector, by_name, integer, moderate, real, rotation, text, vector3
from pybullet._calls.builtin import exported, exported_as
from pybullet._calls.errors import fail
from pybullet._clients.clients import client_of
from pybullet._clients.origins import FileLoad
from pybullet._loading.new_bodies import add_bodies, keep_flags_of_colours, warn_of_coordinates

__all__ = ["loadURDF", "setAdditionalSearchPath"]

_CANNOT_LOAD = "Cannot load URDF file."
_LEGACY_POSE = ("startPosX", "startPosY", "startPosZ", "startOrnX", "startOrnY", "startOrnZ", "startOrnW")
_LEGACY_COUNTS = (3, len(_LEGACY_POSE))


@exported
def setAdditionalSearchPath(path: str, physicsClientId: int = 0) -> None:
    """Sets the directory that is searched for files besides the working directory.

    All connections of the process search it, also later ones; a directory set for the connection itself comes
    first.

    Args:
        path: The directory; replaces the one set before.
        physicsClientId: The connection.

    Raises:
        pybullet.error: Not connected.

    Examples:
        >>> import pybullet_data
        >>> p.setAdditionalSearchPath(pybullet_data.getDataPath())
    """
    client_of(physicsClientId).set_search_path(Path(text(path, "path")))


def _in_usual_form(
    arguments: tuple[Any, ...], keywords: dict[str, Any]
) -> tuple[tuple[Any, ...], dict[str, Any]]:
    """Convert a call with numbers for the pose to one with vectors; return any other call unchanged."""
    options = _legacy_pose(arguments[1:], keywords)
    return (arguments[:1], options) if arguments and options else (arguments, keywords)


@overload
def loadURDF(
    fileName: str,
    basePosition: Vector = ...,
    baseOrientation: Vector = ...,
    useMaximalCoordinates: int = -1,
    useFixedBase: int = 0,
    flags: int = 0,
    globalScaling: float = -1,
    physicsClientId: int = 0,
) -> int: ...
@overload
def loadURDF(
    fileName: str,
    startPosX: float,
    startPosY: float,
    startPosZ: float,
    startOrnX: float = ...,
    startOrnY: float = ...,
    startOrnZ: float = ...,
    startOrnW: float = ...,
) -> int: ...
@exported_as(
    "(fileName, basePosition=(0.0, 0.0, 0.0), baseOrientation=(0.0, 0.0, 0.0, 1.0), "
    "useMaximalCoordinates=-1, useFixedBase=0, flags=0, globalScaling=-1, physicsClientId=0)",
    _in_usual_form,
)
def loadURDF(fileName: str, *arguments: Any, **keywords: Any) -> int:
    """Loads a robot from a URDF file.

    Also called as `loadURDF(fileName, x, y, z)` and `loadURDF(fileName, x, y, z, qx, qy, qz, qw)`.

    Args:
        fileName: The file: as given, in `data` folders near the working directory, or in the directory
            of `setAdditionalSearchPath`.
        *arguments: The parameters below, by position.
        **keywords: The parameters below, by name.
        basePosition: Position of the link frame of the base [m]; its centre of mass may be elsewhere.
        baseOrientation: Orientation of that frame (x, y, z, w).
        useMaximalCoordinates: Bodies always have reduced coordinates in Carom; 1 logs a warning. As in
            PyBullet, air does not slow such bodies, and in deformable worlds external forces act twice.
        useFixedBase: 1 to fix the base in the world.
        flags: `URDF_*`, added up.
        globalScaling: Factor on all lengths; 1 when not greater than 0.
        physicsClientId: The connection.

    Returns:
        The id of the body. The id of the body removed last is used again; otherwise ids count up from 0.

    Raises:
        pybullet.error: Not connected, the file is missing or cannot be used (after PyBullet's text the
            message names file, line, element and reason), or the pose is not three and four finite numbers.
            The world is then unchanged.

    Examples:
        >>> robot = p.loadURDF("r2d2.urdf", basePosition=[0, 2, 0.5])
        >>> p.getNumJoints(robot)
        15
    """
    options = _legacy_pose(arguments, keywords) or _named(arguments, keywords)
    name = text(fileName, "fileName")
    position = vector3(options["basePosition"], "Cannot convert basePosition.", "basePosition")
    orientation = rotation(options["baseOrientation"], "Cannot convert baseOrientation.", "baseOrientation")
    maximal = integer(options["useMaximalCoordinates"], "useMaximalCoordinates")
    fixed_base = integer(options["useFixedBase"], "useFixedBase") != 0
    flags = integer(options["flags"], "flags")
    scaling = real(options["globalScaling"], "globalScaling")
    client = client_of(options["physicsClientId"])
    if not name:
        fail("Empty filename, method expects 1, 4 or 8 arguments.")
    warn_of_coordinates("loadURDF", maximal, client)

    from carom.formats.search import path_of
    from carom.soft.from_urdf import urdf_body

    scale = moderate(scaling, _CANNOT_LOAD, "globalScaling") if scaling > 0.0 else 1.0
    try:
        spec = urdf_body(
            path_of(name),
            client.search(),
            scale=scale,
            flags=flags,
            fixed_base=fixed_base,
            older=not client.deformable,
        )
    except CaromError as problem:
        fail(_CANNOT_LOAD, str(problem))
    load = FileLoad(
        "loadURDF",
        {"useFixedBase": int(fixed_base), "flags": flags, "globalScaling": scaling},
        takes_pose=True,
    )
    poses = [(spec, Pose(position, orientation))]
    body = add_bodies(client, poses, _CANNOT_LOAD, load, maximal=maximal > 0)[0]
    keep_flags_of_colours(client, flags)
    return body


_DEFAULTS = {
    "basePosition": (0.0, 0.0, 0.0),
    "baseOrientation": (0.0, 0.0, 0.0, 1.0),
    "useMaximalCoordinates": -1,
    "useFixedBase": 0,
    "flags": 0,
    "globalScaling": -1,
    "physicsClientId": 0,
}


def _named(arguments: tuple[Any, ...], keywords: dict[str, Any]) -> dict[str, Any]:
    """The options of a call in the usual form; a position or orientation of None gets its default."""
    if not arguments and not keywords:
        return _DEFAULTS
    given = by_name("loadURDF", tuple(_DEFAULTS), arguments, keywords)
    for name in ("basePosition", "baseOrientation"):
        if given.get(name, ()) is None:
            del given[name]
    return {**_DEFAULTS, **given}


def _legacy_pose(arguments: tuple[Any, ...], keywords: dict[str, Any]) -> dict[str, Any] | None:
    """The options of a call with three or seven numbers for the pose; None for any other call."""
    if len(arguments) + len(keywords) not in _LEGACY_COUNTS:
        return None
    numbers: dict[str, Any] = dict(zip(_LEGACY_POSE, arguments, strict=False))
    if len(arguments) > len(_LEGACY_POSE) or set(numbers) & set(keywords):
        return None
    numbers.update(keywords)
    if set(numbers) not in (set(_LEGACY_POSE[:3]), set(_LEGACY_POSE)):
        return None
    try:
        pose = [real(numbers[name], name) for name in _LEGACY_POSE[: len(numbers)]]
    except TypeError:
        return None
    return {
        **_DEFAULTS,
        "basePosition": pose[:3],
        "baseOrientation": pose[3:] or _DEFAULTS["baseOrientation"],
    }
