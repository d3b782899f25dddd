"""What users do to bodies on pages: they pull and turn them, drive joints and actuators, and move handles."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING, Any

from carom.description.pose import Vector3
from carom.viewer.input.drives import MODES, JointHands
from carom.viewer.input.handles import Handles
from carom.viewer.input.picking import Picking
from carom.viewer.input.turning import Turning
from carom.viewer.latest_messages import LatestMessages
from carom.viewer.protocol import from_page
from carom.viewer.protocol.message import Message
from carom.viewer.steps.pause_control import PauseControl
from carom.viewer.steps.sleeping import Sleeping
from carom.viewer.steps.step_queue import StepQueue

if TYPE_CHECKING:
    from carom.scene.core.world_core import WorldCore

Answer = Callable[[int, dict[str, Any]], None]
"""What is done for a message of a page, by the number of the page."""
# How long to wait for the world when a page closes, to end its pulls [s].
_PATIENCE = 1.0


class SceneHands:
    """Hands of users in a world.

    Args:
        world: The world.
        lock: Held while it is changed.
        latest: Where pages are told of handles.
        pause: Whether the simulation is paused.
        steps: Where what has to wait for a step is put.

    Attributes:
        handles: Frames of scripts that users move.
    """

    def __init__(
        self, world: WorldCore, lock: Any, latest: LatestMessages, pause: PauseControl, steps: StepQueue
    ) -> None:
        self.handles = Handles(latest)
        self._pause = pause
        self._steps = steps
        self._joints = JointHands(world)
        self._picking = Picking(world, lock, lambda: pause.closed)
        self._turning = Turning(world, lock, lambda: pause.closed)
        self._sleeping = Sleeping(world)

    def answers(self) -> dict[Message, Answer]:
        """What is done for each message about bodies."""
        return {
            from_page.DRIVE: self._drive,
            from_page.CONTROL: self._control,
            from_page.GIVE_BACK: self._give_back,
            from_page.HANDLE: self.handles.take,
            from_page.SLEEP: lambda page, message: self._steps.add(self._sleeping.toggle),
            from_page.GRASP: self._grasp,
            from_page.PULL: lambda page, message: self._picking.move(page, vector(message["target"])),
            from_page.TURN: self._turning.turn,
            from_page.LET_GO: lambda page, message: self._let_go(page),
        }

    def apply(self) -> None:
        """Do what pages have asked for; if no step ends soon, at the next call."""
        self._picking.apply()
        self._turning.apply()

    def gone(self, page: int) -> None:
        """A page has closed: what it holds is let go."""
        self._let_go(page)
        self._picking.apply(_PATIENCE)
        self._turning.apply(_PATIENCE)

    def _let_go(self, page: int) -> None:
        self._picking.release(page)
        self._turning.release(page)

    def _drive(self, page: int, message: dict[str, Any]) -> None:
        body, joint, target = int(message["body"]), int(message["joint"]), float(message["target"])
        mode = message.get("mode", "position")
        if mode not in MODES:
            raise ValueError(f"a joint has no mode {mode!r}")
        joints, pause = self._joints, self._pause
        self._steps.add(lambda: joints.drive(body, joint, mode, target, place=pause.closed))

    def _control(self, page: int, message: dict[str, Any]) -> None:
        numbers = int(message["body"]), int(message["actuator"]), float(message["control"])
        self._steps.add(partial(self._joints.control, *numbers))

    def _give_back(self, page: int, message: dict[str, Any]) -> None:
        self._steps.add(partial(self._joints.give_back, int(message["body"]), int(message["joint"])))

    def _grasp(self, page: int, message: dict[str, Any]) -> None:
        point, target = vector(message["point"]), vector(message["target"])
        self._picking.take(page, int(message["body"]), int(message["link"]), point, target)


def vector(values: Any) -> Vector3:
    """Three numbers of a message."""
    x, y, z = map(float, values)
    return (x, y, z)
