"""Environments in which arms learn to reach, push, strike and throw."""

from __future__ import annotations

from abc import abstractmethod
from math import inf
from typing import Any

import numpy as np

from pybullet_envs.env_bases import MJCFBaseBulletEnv
from pybullet_envs.robot_manipulators import Pusher, Reacher, SevenJointArm, Striker, Thrower
from pybullet_envs.scene_abstract import SingleRobotEmptyScene

# Joints whose power costs: as in PyBullet, whose policies were trained with it, the upper arm's roll counts
# in place of the forearm's.
COUNTED = tuple("upper_arm_roll_joint" if n == "forearm_roll_joint" else n for n in SevenJointArm.ARM)
WORK, STALL = 0.1, 0.01
INSIDE, WELL_INSIDE = 0.1, 1.01


class _ArmEnv(MJCFBaseBulletEnv):
    restores = True
    _gravity, _timestep, _frame_skip = 9.81, 0.0020, 5

    def create_single_player_scene(self, bullet_client: Any) -> SingleRobotEmptyScene:
        """A scene with nothing but the bodies of the robot's file."""
        return SingleRobotEmptyScene(bullet_client, self._gravity, self._timestep, self._frame_skip)

    def camera_adjust(self) -> None:
        """Looks at a point half way to the fingertip."""
        x, y, z = self.robot.fingertip.pose().xyz().tolist()
        self.camera.move_and_look_at(0.3, 0.3, 0.3, 0.5 * x, 0.5 * y, z)


class ReacherBulletEnv(_ArmEnv):
    """An arm of two links that moves its tip to a target; see `Reacher`.

    Reward: 100 times the decrease of the distance [m], minus costs of effort and of a joint at its limit.
    """

    _gravity, _timestep, _frame_skip = 0.0, 0.0165, 1

    def __init__(self, render: bool = False, render_mode: str | None = None) -> None:
        super().__init__(Reacher(), render, render_mode)

    def step(self, action: Any) -> tuple[np.ndarray, float, bool, bool, dict[str, Any]]:
        """Applies an action for one step."""
        robot = self.robot
        given = np.asarray(action, dtype=float)
        robot.apply_action(action)
        self.scene.global_step()
        state = robot.calc_state()
        before, self.potential = self.potential, robot.calc_potential()
        rates = np.array((robot.theta_dot, robot.gamma_dot))
        effort = WORK * float(np.abs(given * rates).sum()) + STALL * float(np.abs(given).sum())
        stuck = 0.1 if abs(abs(robot.gamma) - 1.0) < 0.01 else 0.0
        self.rewards = [self.potential - before, -effort, -stuck]
        self.HUD(state, action, False)
        return state, sum(self.rewards), False, False, {}


class _SevenJointArmEnv(_ArmEnv):
    """Base class of environments with seven-joint arms; see `SevenJointArm`.

    Reward: minus the effort and, as in PyBullet, minus 0.1 for each joint within its limits. Progress is not
    rewarded; some subclasses add a term for it.
    """

    def step(self, action: Any) -> tuple[np.ndarray, float, bool, bool, dict[str, Any]]:
        """Applies an action for one step; episodes end by their length alone."""
        robot = self.robot
        given = np.asarray(action, dtype=float)
        robot.apply_action(action)
        self.scene.global_step()
        state = robot.calc_state()
        rates = np.array([robot.jdict[name].get_velocity() for name in COUNTED])
        effort = WORK * float(np.abs(given) @ np.abs(rates)) + STALL * float(given.sum())
        joints = robot.ordered_joints
        inside = sum(abs(joint.current_relative_position()[0]) < WELL_INSIDE for joint in joints)
        self.rewards = [-effort, -INSIDE * inside, self._success(float(np.square(given).sum()))]
        self.HUD(state, action, False)
        return state, sum(self.rewards), False, False, {}

    @abstractmethod
    def _success(self, square: float) -> float:
        """The reward of the task itself, given the sum of the squares of the action."""


class PusherBulletEnv(_SevenJointArmEnv):
    """An arm with a fork that pushes a cylinder over a table to a disc; see `Pusher`."""

    def __init__(self, render: bool = False, render_mode: str | None = None) -> None:
        super().__init__(Pusher(), render, render_mode)

    def _success(self, square: float) -> float:
        return 0.0


class StrikerBulletEnv(_SevenJointArmEnv):
    """An arm with a paddle that strikes a ball, which slides over a table into a goal; see `Striker`.

    The task subtracts from the reward three times the smallest distance between ball and goal so far, half
    the distance between ball and paddle (after a strike: where the paddle struck), and a tenth of the squared
    action.

    PyBullet has the class, but its `reset` fails.

    Attributes:
        strike_threshold: Distance between ball and paddle below which the ball is struck [m].
    """

    def __init__(self, render: bool = False, render_mode: str | None = None) -> None:
        super().__init__(Striker(), render, render_mode)
        self.strike_threshold = 0.1

    def _scene_is_set(self) -> None:
        self._nearest = inf
        self._struck_at: np.ndarray | None = None

    def _success(self, square: float) -> float:
        ball, paddle = self.robot.object.pose().xyz(), self.robot.fingertip.pose().xyz()
        self._nearest = min(self._nearest, float(np.linalg.norm(ball - self.robot.target.pose().xyz())))
        if np.linalg.norm(ball - paddle) < self.strike_threshold:
            self._struck_at = paddle
        way = ball - (paddle if self._struck_at is None else self._struck_at)
        return -3.0 * self._nearest - 0.1 * square - 0.5 * float(np.linalg.norm(way))


class ThrowerBulletEnv(_SevenJointArmEnv):
    """An arm with a claw that throws a ball into a basket, without gravity; see `Thrower`.

    The task subtracts from the reward the horizontal distance between ball and basket (once the ball has
    landed: from its landing point), and 0.002 times the squared action.
    """

    _gravity = 0.0
    _ground = -0.25
    """The height below which the ball has landed [m]."""

    def __init__(self, render: bool = False, render_mode: str | None = None) -> None:
        super().__init__(Thrower(), render, render_mode)

    def _scene_is_set(self) -> None:
        self._landed_at: np.ndarray | None = None

    def _success(self, square: float) -> float:
        ball = self.robot.object.pose().xyz()
        if self._landed_at is None and ball[2] < self._ground:
            self._landed_at = ball
        end = ball if self._landed_at is None else self._landed_at
        return -float(np.linalg.norm((end - self.robot.target.pose().xyz())[:2])) - 0.002 * square
