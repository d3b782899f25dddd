"""Converting robot files between formats: `python -m carom convert`."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

from carom.description import Robot
from carom.description.pose import Vector3
from carom.editing.files import read
from carom.editing.losses import Losses
from carom.editing.to_robots import choose, held, joint_for_urdf, with_one_contact, write_robot
from carom.editing.writing_files import MJCF_SUFFIXES
from carom.errors import DescriptionError
from carom.file_bodies import compiled_mjcf_bodies, usd_solids, written_sdf_bodies
from carom.files.boundary import reading
from carom.formats.any_file import read_robots
from carom.formats.kinds import USD_SUFFIXES, FileKind, kind_of
from carom.formats.placed import PlacedRobot
from carom.formats.reading.cursor import Cursor
from carom.formats.reading.ignored import Ignored, IgnoredList
from carom.formats.reading.written import Written
from carom.formats.robot.file import locate
from carom.formats.search import AssetSearch
from carom.formats.shipped import shipped_folder
from carom.formats.urdf.reader import read_written_urdf
from carom.formats.urdf_writer import urdf_text
from carom.model.assemble import assemble
from carom.writing import write_text


def convert(source: Path, target: Path, model: str | None = None) -> IgnoredList:
    """Write a robot or scene as MJCF, as USD, or else as URDF, by the ending of the target's name.

    What an MJCF file describes, and what becomes MJCF or USD, is read as its author means it; what becomes
    URDF from SDF, URDF or USD as PyBullet reads it. A robot that the file fixes to the world gets a base of
    mass 0 in URDF, which is fixed in PyBullet and Carom; in USD a joint holds it. In URDF and USD its pose in
    the world is not kept. Meshes are copied into USD; to URDF and MJCF files their paths are relative, and
    what is in no file, or in one that MuJoCo does not read, is written into or beside the target.

    Args:
        source: SDF, MJCF, URDF or USD file; files of `pybullet_data` are found by name.
        target: The file to write; one that ends in `.usd`, `.usda`, `.usdc` or `.usdz` is USD, one that ends
            in `.xml` or `.mjcf` is MJCF.
        model: Name of the robot, name of its root link, or its number from 0; required for URDF and USD if
            the file has several robots. MJCF has all.

    Returns:
        What the source says and the target does not.

    Raises:
        DescriptionError: The source cannot be used, has no such robot, or cannot be expressed in the target.
        ValueError: A model is chosen for MJCF.
        OSError: The target cannot be written.
    """
    search = AssetSearch(shipped_folder())
    suffix = target.suffix.lower()
    if suffix in MJCF_SUFFIXES:
        return read(source).write(target, model=model)
    if suffix in USD_SUFFIXES:
        return _to_usd(source, target, model, search)
    file = locate(source, search)
    with reading(file):
        kind = kind_of(file)
    if kind is FileKind.MJCF:
        it = read(file)
        return IgnoredList.of(write_robot(it.root, file, search, target, model))
    kind, robots = read_robots(source, search=search, solids=usd_solids)
    robot = _with_moments(held(choose(source, robots, model)))
    losses = Losses(file)
    robot = replace(
        robot,
        links=tuple(with_one_contact(link, losses) for link in robot.links),
        joints=tuple(joint_for_urdf(joint, losses) for joint in robot.joints),
    )
    write_text(target, urdf_text(robot, target.absolute().parent))
    return losses.list()


def _to_usd(source: Path, target: Path, model: str | None, search: AssetSearch) -> IgnoredList:
    """Write a robot as its author means it."""
    from carom.formats.usd.writer import write_usd

    file = locate(source, search)
    with reading(file):
        kind = kind_of(file)
        if kind is FileKind.USD:
            raise DescriptionError(
                "it is USD; `usdcat -o TARGET` of usd-core converts between its forms", file=file
            )
        robots, lost = _AS_WRITTEN[kind](file, search)
    chosen = choose(file, robots, model)
    return IgnoredList.of([*lost, *write_usd(chosen.robot, target, fixed_base=chosen.fixed_base)])


AsWritten = tuple[list[PlacedRobot], list[Ignored]]
"""The robots of a file as its author means it, and what of it is not in their descriptions."""


def _urdf(file: Path, search: AssetSearch) -> AsWritten:
    robot, _ = read_written_urdf(file, Written(), search=search)
    return [PlacedRobot(robot, fixed_base=assemble(robot, as_written=True).fixed_base)], []


def _sdf(file: Path, search: AssetSearch) -> AsWritten:
    from carom.formats.sdf.rules import SDF_RULES

    scene, _ = written_sdf_bodies(file, search, scale=1.0, cursor=Cursor(SDF_RULES))
    counts = {
        "model/plugin": sum(len(model.actuators) for model in scene.models),
        "link/sensor": sum(len(mount.sensors) for model in scene.models for mount in model.mounts),
    }
    return scene.robots, _lost(file, counts)


def _mjcf(file: Path, search: AssetSearch) -> AsWritten:
    model, _ = compiled_mjcf_bodies(file, search, flags=0)
    counts = {
        "mujoco/actuator": len(model.actuators),
        "mujoco/sensor": len(model.sensors),
        "mujoco/equality": len(model.couplings) + len(model.connections),
        "mujoco/tendon": len(model.tendons),
    }
    return list(model.robots), _lost(file, counts)


def _saved(file: Path, _: AssetSearch) -> AsWritten:
    raise DescriptionError("it is a saved world, and no robot file", file=file)


def _lost(file: Path, counts: dict[str, int]) -> list[Ignored]:
    told = "it is not in the stage", "a description of links and joints is written"
    return [Ignored(element, file, 1, (), count, *told) for element, count in counts.items() if count]


_AS_WRITTEN: dict[FileKind, Callable[[Path, AssetSearch], AsWritten]] = {
    FileKind.URDF: _urdf,
    FileKind.SDF: _sdf,
    FileKind.MJCF: _mjcf,
    FileKind.SAVED_WORLD: _saved,
}


def _with_moments(robot: Robot) -> Robot:
    """The robot, with computed moments of inertia for each link that has mass but no moments of inertia."""
    without = {link.name for link in robot.links if link.inertial.mass and not any(link.inertial.tensor)}
    if not without:
        return robot
    body = assemble(robot)
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
