"""Converting robot files to URDF or USD: `python -m carom convert`."""

from __future__ import annotations

from pathlib import Path

from carom.description import Robot
from carom.description.pose import Vector3
from carom.errors import DescriptionError
from carom.formats.any_file import read_robots
from carom.formats.kinds import USD_SUFFIXES, FileKind
from carom.formats.placed import PlacedRobot
from carom.formats.reading.ignored import IgnoredList
from carom.formats.reading.written import Written
from carom.formats.search import AssetSearch
from carom.formats.shipped import shipped_folder
from carom.formats.urdf.reader import read_written_urdf
from carom.formats.urdf_writer import urdf_text
from carom.layouts.flags import LoadFlags
from carom.lazy_dataclasses import replace
from carom.model.assemble import assemble
from carom.model.from_files import usd_solids
from carom.model.mjcf_inertia import set_mjcf_inertias
from carom.writing import write_text


def convert(source: Path, target: Path, model: str | None = None) -> IgnoredList:
    """Write a robot as URDF, or as USD if the name of the target ends so. Its pose in the world is not kept.

    A robot that the file fixes to the world gets a base of mass 0 in URDF, which is fixed in PyBullet and
    Carom; in USD a joint holds it. Links without moments of inertia, as in MJCF files, get those that Carom
    computes from their collision shapes. Meshes are copied into USD, and not for URDF. A URDF file that
    becomes USD is read as its author means it.

    Args:
        source: SDF, MJCF, URDF or USD file; files of `pybullet_data` are found by name.
        target: The file to write; one that ends in `.usd`, `.usda`, `.usdc` or `.usdz` is USD.
        model: Name of the robot, name of its root link, or its number from 0; required if the file has
            several robots.

    Returns:
        What the robot has and a USD target does not say; nothing of URDF.

    Raises:
        DescriptionError: The source cannot be used, has no such robot, or cannot be expressed in the target.
        OSError: The target cannot be written.
    """
    search = AssetSearch(shipped_folder())
    kind, robots = read_robots(source, search=search, solids=usd_solids)
    if target.suffix.lower() not in USD_SUFFIXES:
        robot = _with_moments(_held(_chosen(source, robots, model)), is_mjcf=kind is FileKind.MJCF)
        write_text(target, urdf_text(robot, target.absolute().parent))
        return IgnoredList()
    from carom.formats.usd.writer import write_usd

    if kind is FileKind.URDF:
        robots = [_as_written(robots[0].robot.source or source, search)]
    chosen = _chosen(source, robots, model)
    robot = _with_moments(chosen.robot, is_mjcf=kind is FileKind.MJCF)
    return write_usd(robot, target, fixed_base=chosen.fixed_base)


def _as_written(file: Path, search: AssetSearch) -> PlacedRobot:
    """The robot of a URDF file as its author means it: fixed if links without mass are at its root."""
    robot, _ = read_written_urdf(file, Written(), search=search)
    return PlacedRobot(robot, fixed_base=assemble(robot, as_written=True).fixed_base)


def _with_moments(robot: Robot, *, is_mjcf: bool) -> Robot:
    """The robot, with computed moments of inertia for each link that has mass but no moments of inertia."""
    without = {link.name for link in robot.links if link.inertial.mass and not any(link.inertial.tensor)}
    if not without:
        return robot
    body = assemble(robot, flags=LoadFlags.USE_IMPLICIT_CYLINDER if is_mjcf else LoadFlags.NONE)
    if is_mjcf:
        set_mjcf_inertias(body)
    found = {link.name: link.inertia for link in (body.base, *body.links) if link.name in without}
    links = [
        replace(link, inertial=replace(link.inertial, tensor=_diagonal(found[link.name])))
        if link.name in found
        else link
        for link in robot.links
    ]
    return replace(robot, links=tuple(links))


def _diagonal(moments: Vector3) -> tuple[float, float, float, float, float, float]:
    x, y, z = moments
    return (x, 0.0, 0.0, y, 0.0, z)


def _chosen(source: Path, placed: list[PlacedRobot], model: str | None) -> PlacedRobot:
    if not placed:
        raise DescriptionError("it holds no robot", file=source)
    matching = [
        index
        for index, it in enumerate(placed)
        if model in (None, str(index), it.robot.name, _root_name(it.robot))
    ]
    if len(matching) != 1:
        listed = ", ".join(f"{i} {it.robot.name} ({_root_name(it.robot)})" for i, it in enumerate(placed))
        problem = "several robots fit" if matching else f"there is no robot {model!r}"
        raise DescriptionError(f"{problem}; it holds {listed}", file=source)
    return placed[matching[0]]


def _held(chosen: PlacedRobot) -> Robot:
    """The robot, without mass in its base if that is fixed."""
    robot = chosen.robot
    if not chosen.fixed_base:
        return robot
    root = robot.links[robot.root]
    links = list(robot.links)
    links[robot.root] = replace(root, inertial=replace(root.inertial, mass=0.0))
    return replace(robot, links=tuple(links))


def _root_name(robot: Robot) -> str:
    return robot.links[robot.root].name
