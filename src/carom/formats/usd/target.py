"""The stage that a robot is written into: its prims by name, and what is left out."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from carom.description import Robot
from carom.formats.reading.ignored import Ignored
from carom.formats.usd.library import Library, library
from carom.formats.usd.names import Names
from carom.formats.usd.written_value import Values


class Target:
    """The stage in the making.

    Attributes:
        robot: The robot.
        file: What is written.
        pxr: The library.
        stage: The `Usd.Stage`.
        names: Paths that are taken.
        root: Path of the prim of the robot.
        links: Path of the prim of each link.
        scope: Path of the prim around the joints.
        joints: Path of the prim of each joint, by name.
        held: Path of the joint that holds the root in the world.
        values: What writes attributes.
        lost: What is left out.
    """

    def __init__(self, robot: Robot, file: Path) -> None:
        self.robot: Robot = robot
        self.file: Path = file
        self.pxr: Library = library(file)
        self.stage: Any = self.pxr.Usd.Stage.CreateInMemory(f"{file.stem}.usda")
        self.values: Values = Values(self.pxr, self.stage)
        self.lost: list[Ignored] = []
        self.names: Names = Names()
        self.root: str = self.names.under("", robot.name or "robot")
        self.links: list[str] = [self.names.under(self.root, link.name) for link in robot.links]
        self.scope: str = self.names.under(self.root, "joints")
        self.joints: dict[str, str] = {it.name: self.names.under(self.scope, it.name) for it in robot.joints}
        self.held: str = self.names.under(self.scope, "root")

    def name(self, prim: Any, name: str) -> None:
        """Note the name of what a prim stands for, if it is no name that prims can have."""
        if str(prim.GetName()) != name:
            prim.SetMetadata("displayName", name)
            self.values.put(prim, "carom:name", "String", name)

    def leave_out(self, element: str, consequence: str, reason: str, *attributes: str) -> None:
        """Report what the file does not say."""
        file = self.robot.source or self.file
        self.lost.append(Ignored(element, file, 1, attributes, 1, consequence, reason))
