"""Environments with poles on a cart."""

from __future__ import annotations

from math import cos
from typing import Any

import numpy as np

from pybullet_envs.env_bases import MJCFBaseBulletEnv
from pybullet_envs.robot_pendula import InvertedDoublePendulum, InvertedPendulum, InvertedPendulumSwingup
from pybullet_envs.scene_abstract import SingleRobotEmptyScene


class _CartEnv(MJCFBaseBulletEnv):
    restores = True

    def create_single_player_scene(self, bullet_client: Any) -> SingleRobotEmptyScene:
        """A scene with nothing but the cart and its poles."""
        return SingleRobotEmptyScene(bullet_client, gravity=9.8, timestep=0.0165, frame_skip=1)

    def camera_adjust(self) -> None:
        """Looks at the poles."""
        self.camera.move_and_look_at(0, 1.2, 1.0, 0, 0, 0.5)


class InvertedPendulumBulletEnv(_CartEnv):
    """A pole to keep upright; the reward of each step is 1. See `InvertedPendulum`."""

    fallen = 0.2
    _robot = InvertedPendulum

    def __init__(self, render: bool = False, render_mode: str | None = None) -> None:
        super().__init__(self._robot(), render, render_mode)

    def step(self, action: Any) -> tuple[np.ndarray, float, bool, bool, dict[str, Any]]:
        """Applies an action for one step."""
        self.robot.apply_action(action)
        self.scene.global_step()
        state = self.robot.calc_state()
        angle = self.robot.theta
        self.rewards = [cos(angle) if self.robot.swingup else 1.0]
        done = not self.robot.swingup and abs(angle) > self.fallen
        self.HUD(state, action, done)
        return state, sum(self.rewards), done, False, {}


class InvertedPendulumSwingupBulletEnv(InvertedPendulumBulletEnv):
    """A pole to swing up; the reward of each step is the cosine of its angle from upright."""

    _robot = InvertedPendulumSwingup


class InvertedDoublePendulumBulletEnv(_CartEnv):
    """Two poles to keep upright, one on the other; see `InvertedDoublePendulum`.

    Reward: 10, minus the squared height error of the tip [m], minus 0.01 times the squared x of the upper
    pole's centre.
    """

    # Distance from the centre of the upper pole to its tip, desired height of the tip, and height at which
    # the poles have fallen [m].
    to_tip, aim, fallen = 0.3, 2.0, 1.0

    def __init__(self, render: bool = False, render_mode: str | None = None) -> None:
        super().__init__(InvertedDoublePendulum(), render, render_mode)

    def step(self, action: Any) -> tuple[np.ndarray, float, bool, bool, dict[str, Any]]:
        """Applies an action for one step."""
        self.robot.apply_action(action)
        self.scene.global_step()
        state = self.robot.calc_state()
        tip = self.robot.pos_y + self.to_tip
        self.rewards = [10.0, -0.01 * self.robot.pos_x**2 - (tip - self.aim) ** 2]
        done = tip <= self.fallen
        self.HUD(state, action, done)
        return state, sum(self.rewards), done, False, {}
