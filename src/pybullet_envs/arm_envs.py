"""What the arms that push, strike and throw have in common."""

from __future__ import annotations

from abc import abstractmethod
from typing import Any

import numpy as np

from pybullet_envs.env_bases import checked
from pybullet_envs.robot_bases import MJCFEnv

_JOINTS = (
    *("shoulder_pan_joint", "shoulder_lift_joint", "upper_arm_roll_joint", "elbow_flex_joint"),
    *("forearm_roll_joint", "wrist_flex_joint", "wrist_roll_joint"),
)
# PyBullet counts the upper arm's roll where the forearm's would be due; so trained policies expect it.
_COUNTED = tuple("upper_arm_roll_joint" if name == "forearm_roll_joint" else name for name in _JOINTS)
_TURN = 3.14
_WORK, _STALL = 0.1, 0.01
_INSIDE, _WELL_INSIDE = 0.1, 1.01


class ArmEnv(MJCFEnv):
    """An arm of seven joints, driven with up to 0.05 N m each, an object, and a target for it.

    Observation: of each joint (the arm's, then those that things slide along) position and rate; of each
    joint again the position between its limits, from -1 to 1, and a tenth of its rate; the way from the
    object to the target where they were put; positions of fingertip, object and target.

    Reward: less the effort, and less 0.1 for each joint within its limits, as PyBullet has it; nothing for
    coming nearer, which some arms add.

    Attributes:
        torque: Of an action of one [N m].
        object_place: Where the object was put, from the point that both are drawn around [m].
        target_place: Where the target was put, likewise.
    """

    robot_name = "body0"
    action_count = len(_JOINTS)
    gravity, time_step, frame_skip = 9.81, 0.0020, 5
    torque = 0.05
    object_place: np.ndarray
    target_place: np.ndarray
    middle = np.array([0.45, 0.55, 0.0])
    """The point around which object and target are drawn, from where they are in the file [m]."""

    def _turn_arm(self) -> None:
        for name in _JOINTS:
            self.parts.motors[name].place(self.np_random.uniform(-_TURN, _TURN))

    def _anywhere(self, axes: int) -> np.ndarray:
        """A point within a square or a cube."""
        return self.np_random.uniform(-1.0, 1.0, size=axes)

    def _around(self, axes: int, nearest: float, farthest: float) -> np.ndarray:
        """A point at a distance from the middle that lies between two."""
        way = self._anywhere(axes)
        return way / np.linalg.norm(way) * self.np_random.uniform(nearest, farthest)

    def _slide(self, thing: str, place: np.ndarray) -> None:
        """Puts a thing on its slides, from the middle."""
        for axis, value in zip("xy", place - self.middle[:2], strict=True):
            self.parts.motors[f"{thing}_{axis}"].place(float(value))

    def _put(self, thing: str, place: np.ndarray) -> None:
        """Puts the base of a thing somewhere, from the middle."""
        body = self.parts.links[thing].body
        self._p.resetBasePositionAndOrientation(body, (place - self.middle).tolist(), (0.0, 0.0, 0.0, 1.0))

    def _position(self, link: str) -> np.ndarray:
        return self.parts.links[link].pose()[0]

    def _observe(self) -> np.ndarray:
        motors = self.parts.motors.values()
        states = [motor.state() for motor in motors]
        relative = [motor.relative_state() for motor in motors]
        places = [self._position(link) for link in ("fingertip", "object", "target")]
        way = self.target_place - self.object_place
        return np.concatenate([np.ravel(states), np.ravel(relative), way, *places]).astype(np.float32)

    def step(self, action: Any) -> tuple[np.ndarray, float, bool, bool, dict[str, Any]]:
        """Turns the joints for a step; episodes end by their length alone."""
        given = np.asarray(action, dtype=float)
        for name, share in zip(_JOINTS, checked(action), strict=True):
            self.parts.motors[name].drive(self.torque * share)
        self._p.stepSimulation()
        motors = self.parts.motors
        rates = np.array([motors[name].state()[1] for name in _COUNTED])
        effort = _WORK * float(np.abs(given) @ np.abs(rates)) + _STALL * float(given.sum())
        inside = sum(abs(motor.relative_state()[0]) < _WELL_INSIDE for motor in motors.values())
        reward = self._success(float(np.square(given).sum())) - effort - _INSIDE * inside
        return self._observe(), reward, False, False, {}

    @abstractmethod
    def _success(self, square: float) -> float:
        """What the reward has besides effort and limits, given the sum of the squares of the action."""
