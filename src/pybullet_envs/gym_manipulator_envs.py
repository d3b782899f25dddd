"""Arms that reach, push, strike and throw."""

from __future__ import annotations

from math import cos, inf, sin
from typing import Any

import numpy as np

from pybullet_envs.arm_envs import ArmEnv
from pybullet_envs.env_bases import checked
from pybullet_envs.robot_bases import MJCFEnv, Part

_TARGET_REACH = 0.27
_TURN = 3.14


class ReacherBulletEnv(MJCFEnv):
    """Two links whose tip is to come to a target, driven with up to 0.05 N m.

    Observation: the target (x, y), the way from it to the tip (x, y), cosine, sine and rate of the first
    joint, position and rate of the second. Reward: 100 times the way come nearer, less the effort.
    """

    model, robot_name = "reacher.xml", "body0"
    observation_count, action_count = 9, 2
    gravity = 0.0
    torque = 0.05

    def _place(self) -> None:
        motors = self.parts.motors
        for name in ("target_x", "target_y", "joint0", "joint1"):
            reach = _TURN if name.startswith("joint") else _TARGET_REACH
            motors[name].place(self.np_random.uniform(-reach, reach))
        self._distance = self._way()[1]

    def _way(self) -> tuple[np.ndarray, float]:
        """From the target to the tip, and how long that is [m]."""
        way = self.parts.links["fingertip"].pose()[0] - self.parts.links["target"].pose()[0]
        return way, float(np.linalg.norm(way))

    def _observe(self) -> np.ndarray:
        motors = self.parts.motors
        turn, rate = motors["joint0"].relative_state()
        bend, bend_rate = motors["joint1"].relative_state()
        target = [motors[name].state()[0] for name in ("target_x", "target_y")]
        way = self._way()[0]
        return np.array([*target, way[0], way[1], cos(turn), sin(turn), rate, bend, bend_rate], np.float32)

    def step(self, action: Any) -> tuple[np.ndarray, float, bool, bool, dict[str, Any]]:
        """Turns the joints for a step."""
        given = np.asarray(action, dtype=float)
        for name, share in zip(("joint0", "joint1"), checked(action), strict=True):
            self.parts.motors[name].drive(self.torque * share)
        self._p.stepSimulation()
        before, self._distance = self._distance, self._way()[1]
        rates = np.array([self.parts.motors[name].relative_state()[1] for name in ("joint0", "joint1")])
        effort = 0.1 * float(np.abs(given * rates).sum()) + 0.01 * float(np.abs(given).sum())
        bend = self.parts.motors["joint1"].relative_state()[0]
        stuck = 0.1 if abs(abs(bend) - 1.0) < 0.01 else 0.0
        return self._observe(), 100.0 * (before - self._distance) - effort - stuck, False, False, {}


class PusherBulletEnv(ArmEnv):
    """A fork is to push a cylinder over a table to a disc; see `ArmEnv`. Object and target slide."""

    model, observation_count = "pusher.xml", 55

    def _place(self) -> None:
        self.target_place = self._around(2, 0.5, 0.8)
        way = self._anywhere(2)
        apart = float(np.linalg.norm(way - self.target_place))
        self.object_place = way / apart * self.np_random.uniform(0.1, 0.4)
        self._slide("target", self.target_place)
        self._slide("object", self.object_place)
        self._turn_arm()

    def _success(self, square: float) -> float:
        return 0.0


class StrikerBulletEnv(ArmEnv):
    """A paddle is to strike a ball that slides over a table into a goal; see `ArmEnv`.

    The reward takes off three times the least distance of ball and goal so far, half the way from the ball to
    the paddle (to where it struck, once it has), and a tenth of the squared action.

    PyBullet has the class, but its `reset` fails.
    """

    model, observation_count = "striker.xml", 48
    strike_threshold = 0.1
    """Distance of ball and paddle at which the ball is struck [m]."""

    def _load(self) -> None:
        super()._load()
        goals = (body for body in range(self._p.getNumBodies()) if self._p.getBodyInfo(body)[0] == b"target")
        self.parts.links["target"] = Part(self._p, next(goals), -1)

    def _place(self) -> None:
        self._nearest = inf
        self._struck_at: np.ndarray | None = None
        self._turn_arm()
        on_table = self._around(2, 0.1, 0.8)
        self.object_place = np.append(on_table, 0.0)
        self._slide("object", on_table)
        self.target_place = self._around(3, 0.1, 0.8)
        self._put("target", self.target_place)

    def _success(self, square: float) -> float:
        ball, paddle = self._position("object"), self._position("fingertip")
        self._nearest = min(self._nearest, float(np.linalg.norm(ball - self._position("target"))))
        if np.linalg.norm(ball - paddle) < self.strike_threshold:
            self._struck_at = paddle
        way = ball - (paddle if self._struck_at is None else self._struck_at)
        return -3.0 * self._nearest - 0.1 * square - 0.5 * float(np.linalg.norm(way))


class ThrowerBulletEnv(ArmEnv):
    """A claw is to throw a ball into a basket, without gravity; see `ArmEnv`.

    The reward takes off the distance of ball and basket across the ground, that of where the ball came down
    once it has, and 0.002 times the squared action.
    """

    model, observation_count = "thrower.xml", 48
    gravity = 0.0
    ground = -0.25
    """The height below which the ball has come down [m]."""

    def _place(self) -> None:
        self._landed_at: np.ndarray | None = None
        self._turn_arm()
        self.object_place = self._around(3, 0.1, 0.8)
        self._put("object", self.object_place)
        self.target_place = self._around(3, 0.1, 0.8)
        self._put("target", self.target_place)

    def _success(self, square: float) -> float:
        ball = self._position("object")
        if self._landed_at is None and ball[2] < self.ground:
            self._landed_at = ball
        end = ball if self._landed_at is None else self._landed_at
        return -float(np.linalg.norm((end - self._position("target"))[:2])) - 0.002 * square
