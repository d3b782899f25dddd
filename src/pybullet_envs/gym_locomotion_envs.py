"""Environments in which robots learn to run."""

from __future__ import annotations

from typing import Any

import numpy as np

from pybullet_envs.env_bases import MJCFBaseBulletEnv
from pybullet_envs.robot_locomotors import (
    Ant,
    HalfCheetah,
    Hopper,
    Humanoid,
    HumanoidFlagrun,
    HumanoidFlagrunHarder,
    Walker2D,
)
from pybullet_envs.scene_stadium import SinglePlayerStadiumScene

# Factor of the effort costs: 17 joints, of which 4 matter for walking.
_EFFORT_OF_PEOPLE = 4.25


class WalkerBaseBulletEnv(MJCFBaseBulletEnv):
    """A robot learns to run to a goal; see `pybullet_envs.robot_locomotors.WalkerBase`.

    Reward: alive bonus and progress towards the goal, minus costs of effort and of joints at their limits.

    Attributes:
        electricity_cost: Weight of the motors' mean power in the reward.
        stall_torque_cost: Weight of the mean squared action, for torques at rest.
        joints_at_limit_cost: Reward for each joint at a limit.
        foot_ground_object_names: Names of the links that count as ground for feet.
        ground_ids: The same links as (body, link).
    """

    restores = True
    electricity_cost = -2.0
    stall_torque_cost = -0.1
    joints_at_limit_cost = -0.1
    foot_ground_object_names = frozenset({"floor"})
    ground_ids: frozenset[tuple[int, int]]

    def __init__(self, robot: Any, render: bool = False, render_mode: str | None = None) -> None:
        """Makes an environment of a robot; see `MJCFBaseBulletEnv`."""
        super().__init__(robot, render, render_mode)

    def create_single_player_scene(self, bullet_client: Any) -> Any:
        """A stadium."""
        self.stadium_scene = SinglePlayerStadiumScene(
            bullet_client, gravity=9.8, timestep=0.0165 / 4, frame_skip=4
        )
        return self.stadium_scene

    def _scene_is_set(self) -> None:
        if self.stateId >= 0:
            return
        # As in PyBullet the floor is one of the robot's parts, and so part of their mean position.
        self.parts, self.jdict, self.ordered_joints, _ = self.robot.addToScene(
            self._p, self.stadium_scene.ground_plane_mjcf
        )
        ground = [self.parts[name] for name in self.foot_ground_object_names]
        self.ground_ids = frozenset((part.body, part.bodyPartIndex) for part in ground)

    def step(self, action: Any) -> tuple[np.ndarray, float, bool, bool, dict[str, Any]]:
        """Applies an action for one step."""
        robot = self.robot
        given = np.asarray(action, dtype=float)
        robot.apply_action(action)
        self.scene.global_step()
        # As in PyBullet an observation has the foot contacts of the previous step.
        state = robot.calc_state()
        self._alive = float(robot.alive_bonus(float(state[0]) + robot.initial_z, robot.body_rpy[1]))
        done = self._isDone()
        before, self.potential = self.potential, robot.calc_potential()
        on_ground = self._on_ground({foot.body for foot in robot.feet})
        robot.feet_contact[:] = [(foot.body, foot.bodyPartIndex) in on_ground for foot in robot.feet]
        work = self.electricity_cost * float(np.abs(given * robot.joint_speeds).mean())
        stall = self.stall_torque_cost * float(np.square(given).mean())
        at_limit = self.joints_at_limit_cost * robot.joints_at_limit
        self.rewards = [self._alive, self.potential - before, work + stall, at_limit]
        self.HUD(state, action, done)
        return state, sum(self.rewards), done, False, {}

    def _on_ground(self, bodies: set[int]) -> set[tuple[int, int]]:
        """The links of some bodies that touch the ground, as (body, link)."""
        return {
            (body, contact[3])
            for body in bodies
            for contact in self._p.getContactPoints(body)
            if (contact[2], contact[4]) in self.ground_ids
        }

    def _isDone(self) -> bool:
        """Whether the episode is over."""
        return self._alive < 0.0

    def camera_adjust(self) -> None:
        """Looks at the robot."""
        x, y, _ = self._looked_at()
        self.camera.move_and_look_at(x, y, 1.4, x, y, 1.0)


class HopperBulletEnv(WalkerBaseBulletEnv):
    """A hopper with one leg."""

    def __init__(self, render: bool = False, render_mode: str | None = None) -> None:
        super().__init__(Hopper(), render, render_mode)


class Walker2DBulletEnv(WalkerBaseBulletEnv):
    """A biped in a plane."""

    def __init__(self, render: bool = False, render_mode: str | None = None) -> None:
        super().__init__(Walker2D(), render, render_mode)


class HalfCheetahBulletEnv(WalkerBaseBulletEnv):
    """A runner with two legs in a plane. A fall is penalised, but does not end the episode."""

    def __init__(self, render: bool = False, render_mode: str | None = None) -> None:
        super().__init__(HalfCheetah(), render, render_mode)

    def _isDone(self) -> bool:
        return False


class AntBulletEnv(WalkerBaseBulletEnv):
    """A quadruped: four legs around a sphere."""

    def __init__(self, render: bool = False, render_mode: str | None = None) -> None:
        super().__init__(Ant(), render, render_mode)


class HumanoidBulletEnv(WalkerBaseBulletEnv):
    """A humanoid."""

    def __init__(
        self, robot: Humanoid | None = None, render: bool = False, render_mode: str | None = None
    ) -> None:
        """Makes an environment of a `Humanoid`, or of another robot of this kind."""
        super().__init__(Humanoid() if robot is None else robot, render, render_mode)
        self.electricity_cost = _EFFORT_OF_PEOPLE * WalkerBaseBulletEnv.electricity_cost
        self.stall_torque_cost = _EFFORT_OF_PEOPLE * WalkerBaseBulletEnv.stall_torque_cost


class HumanoidFlagrunBulletEnv(HumanoidBulletEnv):
    """A humanoid that runs to flags; see `HumanoidFlagrun`."""

    def __init__(self, render: bool = False, render_mode: str | None = None) -> None:
        super().__init__(HumanoidFlagrun(), render, render_mode)


class HumanoidFlagrunHarderBulletEnv(HumanoidBulletEnv):
    """A humanoid that runs to flags while a cube is thrown at it; see `HumanoidFlagrunHarder`."""

    def __init__(self, render: bool = False, render_mode: str | None = None) -> None:
        super().__init__(HumanoidFlagrunHarder(), render, render_mode)
