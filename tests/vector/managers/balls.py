"""A small task: balls that are pushed by actions."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import gymnasium
import numpy as np
from tests.physics.contact_scenes import add_ball, earth

from carom.vector.managers import (
    Command,
    Curriculum,
    Event,
    ManagerEnv,
    Observation,
    Reward,
    Task,
    Termination,
)

COUNT = 4
STEP = 2.0 / 240.0


def lift(env: Balls, worlds: np.ndarray) -> None:
    """Put the balls at random heights."""
    heights = env.random.uniform(worlds, 1.0, 2.0)
    places = np.column_stack([np.zeros((len(worlds), 2)), heights])
    env.ball.set_base_inertial_poses(places, where=worlds)


def weigh(env: Balls, worlds: np.ndarray) -> None:
    """Choose masses."""
    env.ball.change_dynamics(-1, mass=env.random.uniform(worlds, 0.5, 2.0), where=worlds)


def kick(env: Balls, worlds: np.ndarray) -> None:
    """Kick downwards."""
    env.kicks[worlds] += 1
    env.ball.set_base_velocities((0.0, 0.0, -1.0, 0.0, 0.0, 0.0), where=worlds)


def harder(env: Balls, worlds: np.ndarray) -> float:
    """Note how low the balls have come."""
    env.levels[worlds] += env.ball.base_inertial_poses[worlds, 2] < 1.0
    return float(env.levels.sum())


def wanted(env: Balls, worlds: np.ndarray) -> np.ndarray:
    """A height to reach."""
    return env.random.uniform(worlds, 0.0, 1.0, 1)


TASK = Task(
    observations={
        "height": Observation(lambda env: env.ball.base_inertial_poses[:, 2]),
        "velocity": Observation(lambda env: env.ball.base_velocities[:, :3], scale=0.5, noise=0.1),
        "wanted": Observation(lambda env: env.commands["wanted"]),
    },
    rewards={
        "height": Reward(lambda env: env.ball.base_inertial_poses[:, 2], 2.0),
        "effort": Reward(lambda env: np.square(env.actions).sum(axis=1), -1.0),
    },
    terminations={
        "low": Termination(lambda env: env.ball.base_inertial_poses[:, 2] < 0.9),
        "high": Termination(lambda env: env.ball.base_inertial_poses[:, 2] > 3.0, time_out=True),
    },
    events={
        "weigh": Event(weigh, "start"),
        "lift": Event(lift),
        "kick": Event(kick, "interval", seconds=(0.05, 0.1)),
    },
    commands={"wanted": Command(wanted, seconds=(0.1, 0.2))},
    curriculum={"level": Curriculum(harder)},
)


class Balls(ManagerEnv):
    """Balls of one world each; an action is a force upwards."""

    def __init__(self, num_envs: int = COUNT, task: Task = TASK, **options: Any) -> None:
        world = earth()
        self._body = add_ball(world, (0.0, 0.0, 1.5))
        action = np.ones(1, np.float32)
        super().__init__(world, num_envs, gymnasium.spaces.Box(-action, action), task, steps=2, **options)

    def prepare(self) -> None:
        self.ball = self.worlds[self._body]
        self.levels = np.zeros(self.num_envs, dtype=np.int64)
        self.kicks = np.zeros(self.num_envs, dtype=np.int64)

    def apply(self, actions: np.ndarray) -> None:
        force = np.concatenate([np.zeros((self.num_envs, 2)), actions], axis=1)
        self.ball.links[-1].apply_force(force)


def changed(**terms: Any) -> Task:
    """The task with other terms."""
    return replace(TASK, **terms)


def actions(count: int, step: int) -> np.ndarray:
    """Some actions, which depend on the world and the step."""
    return np.sin(np.arange(count)[:, None] + step)
