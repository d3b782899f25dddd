"""Bodies of the world that tendons or actuators tie to each other: they become one robot.

What acts on two trees of joints at once has to be within one robot. So the trees hang side by side from the
massless link of the world, which all robots with joints at their root have. Free bodies get joints for
that, see `hanging`.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

from carom.formats.mjcf.compiled.actuation.hanging import hang
from carom.formats.mjcf.compiled.context import CompiledContext
from carom.formats.mjcf.compiled.model import CompiledBody, CompiledModel
from carom.formats.mjcf.compiled.robots import robot_of_bodies


class Ties:
    """Which bodies of the world are one robot."""

    def __init__(self, world: CompiledBody) -> None:
        self._bodies = {body.name: body for body in world.children}
        self._groups = {name: [name] for name in self._bodies}

    def join(self, bodies: Iterable[str]) -> str:
        """Make bodies of the world one robot, given by names.

        Returns:
            Why they cannot be; empty if they can.
        """
        names = {*bodies}
        if len(names) > 1 and any(self._bodies[name].is_mocap for name in names):
            return "it ties a mocap body to others that move"
        members = {member for name in names for member in self._groups[name]}
        whole = [name for name in self._bodies if name in members]
        self._groups.update(dict.fromkeys(whole, whole))
        return ""

    def apply(self, model: CompiledModel, context: CompiledContext) -> None:
        """Put the robots of a model together that are tied, and their tendons; free bodies get joints."""
        tied = {name: "+".join(group) for name, group in self._groups.items() if len(group) > 1}
        if not tied:
            return
        for name in tied:
            if self._bodies[name].is_free:
                hang(self._bodies[name], model, context)
        robots = []
        for placed in model.robots:
            group = self._groups.get(placed.robot.name, [placed.robot.name])
            if len(group) == 1:
                robots.append(placed)
            elif group[0] == placed.robot.name:
                robots.append(robot_of_bodies([self._bodies[name] for name in group], tied[group[0]]))
        model.robots = robots
        for name, tendon in model.tendons.items():
            model.tendons[name] = replace(tendon, robot=tied.get(tendon.robot, tendon.robot))
