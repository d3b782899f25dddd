"""Any robot file as URDF."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from carom.description import Robot
from carom.errors import DescriptionError
from carom.formats.any_file import read_robots
from carom.formats.placed import PlacedRobot
from carom.formats.urdf_writer import urdf_text


def convert(source: Path, target: Path, model: str | None = None) -> None:
    """Writes a robot as URDF. Where the file puts it in the world is lost.

    A robot that the file nails to the world gets a base without mass, which PyBullet and Carom do not
    move. Meshes are not copied.

    Args:
        source: SDF, MJCF (`.xml` or `.mjcf`) or URDF file.
        target: The file to write.
        model: Name of the robot, of its root link, or its number from 0; needed where there are several.

    Raises:
        DescriptionError: The source cannot be used or holds no such robot, or URDF cannot say what is in it.
        OSError: The target cannot be written.
    """
    text = urdf_text(_chosen(source, read_robots(source), model), target.absolute().parent)
    target.write_text(text, encoding="utf-8")


def _chosen(source: Path, placed: list[PlacedRobot], model: str | None) -> Robot:
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
    chosen = placed[matching[0]]
    robot = chosen.robot
    if not chosen.fixed_base:
        return robot
    root = robot.links[robot.root]
    links = list(robot.links)
    links[robot.root] = replace(root, inertial=replace(root.inertial, mass=0.0))
    return replace(robot, links=tuple(links))


def _root_name(robot: Robot) -> str:
    return robot.links[robot.root].name
