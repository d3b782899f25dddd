"""Driving joints and actuators of the chosen one of many worlds by the sliders of pages."""

from __future__ import annotations

from collections.abc import Callable
from math import isfinite
from typing import TYPE_CHECKING, Any

from carom.native.uninterrupted import uninterrupted
from carom.viewer.input.drives import MODES, JointHands
from carom.viewer.input.scene_hands import Answer
from carom.viewer.protocol import from_page
from carom.viewer.protocol.message import Message

if TYPE_CHECKING:
    from carom.viewer.many.feed import ManyFeed
    from carom.viewer.many.shown import ShownWorlds
    from carom.viewer.steps.pause_control import PauseControl
    from carom.viewer.steps.step_queue import StepQueue


class ManyJoints:
    """Moves joints of the worlds by sliders, as `JointHands` does in one, and gives them back.

    The motors are set in the chosen world as a `World`, and its rows are then written to the engine of all.
    """

    def __init__(self, shown: ShownWorlds, feed: ManyFeed, pause: PauseControl, steps: StepQueue) -> None:
        self._shown = shown
        self._feed = feed
        self._pause = pause
        self._steps = steps
        self._hands: dict[int, JointHands] = {}

    def answers(self) -> dict[Message, Answer]:
        """What is done for each message about joints and actuators."""
        return {
            from_page.DRIVE: self._drive,
            from_page.CONTROL: self._control,
            from_page.GIVE_BACK: self._give_back,
        }

    def _drive(self, page: int, message: dict[str, Any]) -> None:
        joint, target = int(message["joint"]), float(message["target"])
        mode = message.get("mode", "position")
        if mode not in MODES:
            raise ValueError(f"a joint has no mode {mode!r}")
        if not isfinite(target):
            return

        def drive(hands: JointHands, body: int, world: int) -> None:
            hands.drive(body, joint, mode, target, place=False)
            if self._pause.closed and mode == "position":
                self._shown.worlds[body].joints[joint].reset(target, where=[world])

        self._between_steps(message, joint, drive)

    def _give_back(self, page: int, message: dict[str, Any]) -> None:
        joint = int(message["joint"])
        self._between_steps(message, joint, lambda hands, body, world: hands.give_back(body, joint))

    def _control(self, page: int, message: dict[str, Any]) -> None:
        found = self._feed.body_of(int(message["body"]))
        actuator, control = int(message["actuator"]), float(message["control"])
        body = None if found is None else self._shown.lone.bodies.get(found[1])
        if found is None or body is None or not isfinite(control):
            return
        if not 0 <= actuator < len(body.spec.actuators):
            return
        row, glimpses = body.rows.first["actuator"] + actuator, self._shown.worlds.glimpses
        self._steps.add(lambda: glimpses.put("actuator_control", found[0], row, control))

    def _between_steps(
        self, message: dict[str, Any], joint: int, act: Callable[[JointHands, int, int], None]
    ) -> None:
        """Changes the motor of a joint of a world between two steps; nothing if there is no such joint."""
        found = self._feed.body_of(int(message["body"]))
        body = None if found is None else self._shown.lone.bodies.get(found[1])
        if found is None or body is None or not 0 <= joint < body.joint_count:
            return
        if body.velocity_count[joint] != 1:
            return
        world, row = found[0], body.velocity_index[joint]

        def change() -> None:
            lone, glimpses = self._shown.lone, self._shown.worlds.glimpses
            with uninterrupted, lone.lock:
                glimpses.refill(lone, world, parameters=False)
                act(self._hands.setdefault(world, JointHands(lone)), body.id, world)
                for name, rows in (("dof_motor", lone.motor), ("dof_pd", lone.pd)):
                    glimpses.put(name, world, row, rows[row])
            self._shown.look(0.0)

        self._steps.add(change)
