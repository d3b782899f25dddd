"""A Panda arm that grasps, lifts and releases a brick, by itself or controlled by the keys 1 to 6."""

from __future__ import annotations

from collections.abc import Sequence
from math import cos, sin
from typing import Any

from pybullet_robots.panda._arm import (
    ARM_JOINTS,
    END_EFFECTOR,
    FINGERS,
    FIRST_POSE,
    LOWER,
    RANGES,
    UPPER,
    PandaOverTray,
)

useNullSpace = 1
ikSolver = 0
pandaEndEffectorIndex = END_EFFECTOR
pandaNumDofs = ARM_JOINTS
ll, ul, jr = LOWER, UPPER, RANGES
jointPositions = rp = FIRST_POSE

# States of the arm.
_WAIT, _CIRCLE_LOW, _CIRCLE_HIGH, _OVER_BRICK, _AT_BRICK, _OPEN, _CLOSE, _TO_MIDDLE = range(8)
_LOW, _HIGH = 0.03, 0.2
_KEPT = 0.9
"""Weight of the hand's present height in a step; the rest is the weight of its target height."""


class PandaSim(PandaOverTray):
    """A Panda arm controlled by keys.

    Attributes:
        state: 0 waits, 1 and 2 circle low and high, 3 moves above a brick, 4 down to it, 5 opens and 6
            closes the hand, 7 moves the hand to the middle.
        control_dt: Time that `step` adds to `t` [s].
        finger_target: Target position of the fingers [m].
        gripper_height: Height of the hand [m].
    """

    def __init__(self, bullet_client: Any, offset: Sequence[float]) -> None:
        """Loads everything; see `PandaOverTray`."""
        bullet_client.setPhysicsEngineParameter(solverResidualThreshold=0)
        super().__init__(bullet_client, offset)
        bullet_client.changeVisualShape(self.legos[0], -1, rgbaColor=[1, 0, 0, 1])
        self.state = _WAIT
        self.control_dt = 1.0 / 240.0
        self.finger_target = 0.0
        self.gripper_height = _HIGH
        self.prev_pos: list[float] = [float(number) for number in self.offset]
        self._keep_fingers_centred()

    def _keep_fingers_centred(self) -> None:
        client = self.bullet_client
        gear = client.createConstraint(
            self.panda, FINGERS[0], self.panda, FINGERS[1], client.JOINT_GEAR, [1, 0, 0], [0, 0, 0], [0, 0, 0]
        )
        client.changeConstraint(gear, gearRatio=-1, erp=0.1, maxForce=50)

    def update_state(self) -> None:
        """Sets `state` from the keys 1 to 6; releasing a key sets it to 0."""
        client = self.bullet_client
        for key, what in client.getKeyboardEvents().items():
            if what & client.KEY_WAS_TRIGGERED and ord("1") <= key <= ord("6"):
                self.state = key - ord("0")
            if what & client.KEY_WAS_RELEASED:
                self.state = _WAIT

    def step(self) -> None:
        """Sets the motors; the script calls `stepSimulation`."""
        client = self.bullet_client
        self.finger_target = {_CLOSE: 0.01, _OPEN: 0.04}.get(self.state, self.finger_target)
        client.submitProfileTiming("step")
        self.update_state()
        if self.state in (_CIRCLE_LOW, _CIRCLE_HIGH, _OVER_BRICK, _AT_BRICK, _TO_MIDDLE):
            place = self._next_place()
            client.submitProfileTiming("IK")
            self._move_hand(place, 20)
            client.submitProfileTiming()
        for finger in FINGERS:
            client.setJointMotorControl2(
                self.panda, finger, client.POSITION_CONTROL, self.finger_target, force=10
            )
        client.submitProfileTiming()

    def _next_place(self) -> list[float]:
        """Advances the path and returns the target position of the hand [m]."""
        self.gripper_height = _KEPT * self.gripper_height + (1 - _KEPT) * _LOW
        if self.state in (_CIRCLE_HIGH, _OVER_BRICK, _TO_MIDDLE):
            self.gripper_height = _KEPT * self.gripper_height + (1 - _KEPT) * _HIGH
        time, (x, y, z) = self.t, self.offset
        self.t += self.control_dt
        if self.state in (_OVER_BRICK, _AT_BRICK):
            brick, _ = self.bullet_client.getBasePositionAndOrientation(self.legos[0])
            self.prev_pos = [brick[0], self.gripper_height, brick[2]]
            return self.prev_pos
        if self.state == _TO_MIDDLE:
            place = self.prev_pos
            self.prev_pos = [place[0] - 0.1 * (place[0] - x), place[1], place[2] - 0.1 * (place[2] - z + 0.6)]
            return place
        return [x + 0.2 * sin(1.5 * time), y + self.gripper_height, z - 0.6 + 0.1 * cos(1.5 * time)]


class PandaSimAuto(PandaSim):
    """A Panda arm that repeats a fixed sequence of states.

    Attributes:
        states: The sequence of states.
        state_durations: Duration of each state [s].
        cur_state: Index of the present state in `states`.
        state_t: Time spent in the present state [s].
    """

    def __init__(self, bullet_client: Any, offset: Sequence[float]) -> None:
        """Loads everything; see `PandaOverTray`."""
        super().__init__(bullet_client, offset)
        self.state_t = 0.0
        self.cur_state = 0
        self.states = [_WAIT, _OVER_BRICK, _OPEN, _AT_BRICK, _CLOSE, _OVER_BRICK, _TO_MIDDLE]
        self.state_durations = [1, 1, 1, 2, 1, 1, 10]

    def update_state(self) -> None:
        """Changes to the next state when the duration of the present one is over."""
        self.state_t += self.control_dt
        if self.state_t > self.state_durations[self.cur_state]:
            self.cur_state = (self.cur_state + 1) % len(self.states)
            self.state_t = 0.0
            self.state = self.states[self.cur_state]
