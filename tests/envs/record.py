"""Two episodes of each environment with fixed starts and actions, as recorded with PyBullet.

    .oracle/bin/python tests/envs/record.py

PyBullet's own environments are written for the gym of old, of which little is needed here.
"""

from __future__ import annotations

import importlib
import json
import random
import sys
import types
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

RECORD = Path(__file__).with_name("pybullet.json")
ACTIONS = {
    "gym_pendulum_envs:InvertedPendulumBulletEnv": 1,
    "gym_pendulum_envs:InvertedPendulumSwingupBulletEnv": 1,
    "gym_pendulum_envs:InvertedDoublePendulumBulletEnv": 1,
    "gym_manipulator_envs:ReacherBulletEnv": 2,
    "gym_manipulator_envs:PusherBulletEnv": 7,
    "gym_manipulator_envs:ThrowerBulletEnv": 7,
    "gym_locomotion_envs:HopperBulletEnv": 3,
    "gym_locomotion_envs:Walker2DBulletEnv": 6,
    "gym_locomotion_envs:HalfCheetahBulletEnv": 6,
    "gym_locomotion_envs:AntBulletEnv": 8,
    "gym_locomotion_envs:HumanoidBulletEnv": 17,
    "gym_locomotion_envs:HumanoidFlagrunBulletEnv": 17,
    "gym_locomotion_envs:HumanoidFlagrunHarderBulletEnv": 17,
    "bullet.cartpole_bullet:CartPoleContinuousBulletEnv": 1,
}
"""Environments by module and class, and the numbers of an action."""

STEPS = dict.fromkeys(ACTIONS, 8) | {"gym_locomotion_envs:HumanoidFlagrunHarderBulletEnv": 20}
"""How many are recorded of each: the last one is to sink to the ground, where other rewards begin."""

FIRST_DRAW = dict.fromkeys(ACTIONS, 0) | {"gym_manipulator_envs:PusherBulletEnv": 13}
"""Where episodes begin in `EvenChance`: the pusher's fork is not to begin within the table."""

ON_OUR_DATA = {"bullet.kukaGymEnv:KukaGymEnv": (3, 7), "bullet.racecarGymEnv:RacecarGymEnv": (2, None)}
"""Environments whose robots touch the ground or things with meshes, which are our own here: the numbers of an
action, and how many there are to choose from. The car skids when it is thrown into reverse by a choice:
PyBullet's own ends 20 cm away when it begins a micrometre aside, so only its gentle drive is recorded.
"""
STEPS_ON_OUR_DATA = 6
OUR_DATA = Path(__file__).parents[2] / "src" / "pybullet_data"

Episode = list[tuple[list[float], float]]
Episodes = list[Episode]


class EvenChance:
    """Numbers in place of random ones: the same in every run, whatever draws them."""

    def __init__(self, drawn: int = 0) -> None:
        self._drawn = drawn

    def uniform(self, low: float = 0.0, high: float = 1.0, size: Any = None) -> Any:
        count = 1 if size is None else int(np.prod(size))
        shares = [((self._drawn + number) * 0.37) % 1.0 for number in range(count)]
        self._drawn += count
        values = low + (high - low) * np.array(shares)
        return float(values[0]) if size is None else values.reshape(size)


def action(name: str, step: int) -> np.ndarray:
    return 0.5 * np.sin(0.1 * step + np.arange(ACTIONS[name]))


def action_on_our_data(name: str, discrete: bool, step: int) -> Any:
    numbers, choices = ON_OUR_DATA[name]
    if discrete and choices:
        return (2 * step + 5) % choices
    return 0.5 * np.sin(0.1 * step + np.arange(numbers))


def old_gym() -> None:
    """What PyBullet's environments import of gym, which is not kept up any more."""
    spaces: Any = types.ModuleType("gym.spaces")
    spaces.Box = spaces.Discrete = lambda *_arguments, **_keywords: None
    modules: dict[str, Any] = {
        name: types.ModuleType(name)
        for name in ("gym", "gym.utils", "gym.utils.seeding", "gym.envs", "gym.envs.registration")
    }
    gym = modules["gym"]
    gym.Env, gym.spaces, gym.__version__ = type("Env", (), {}), spaces, "0.21"
    gym.utils, gym.envs = modules["gym.utils"], modules["gym.envs"]
    gym.utils.seeding, gym.envs.registration = modules["gym.utils.seeding"], modules["gym.envs.registration"]
    gym.utils.seeding.np_random = lambda seed=None: (EvenChance(), 0)
    registration = gym.envs.registration
    registration.registry, registration.make, registration.spec = (
        types.SimpleNamespace(env_specs={}),
        None,
        None,
    )
    registration.register = lambda *arguments, **keywords: None
    sys.modules.update(modules | {"gym.spaces": spaces})


def without_a_server() -> None:
    """Clients of environments try a server first, of which there may be one that belongs to others."""
    import pybullet
    from pybullet_utils import bullet_client

    bullet_client.BulletClient = partial(bullet_client.BulletClient, connection_mode=pybullet.DIRECT)


def _let_the_claw_be(bullet: Any) -> None:
    """The thrower's wires coincide, and PyBullet's contacts among them brake the arm that has them all."""
    arm = 1
    wires = [joint for joint in range(bullet.getNumJoints(arm)) if bullet.getJointInfo(arm, joint)[16] == 15]
    for first in wires:
        for second in wires:
            bullet.setCollisionFilterPair(arm, arm, first, second, 0)


def _episodes_of_pybullet(name: str) -> Episodes:
    module, _, kind = name.partition(":")
    env = getattr(importlib.import_module(f"pybullet_envs.{module}"), kind)()
    episodes = []
    for _ in range(2):
        env.np_random = EvenChance(FIRST_DRAW[name])
        if hasattr(env, "robot"):
            env.robot.np_random = env.np_random
        episode = [(np.asarray(env.reset(), float).tolist(), 0.0)]
        if kind == "ThrowerBulletEnv":
            _let_the_claw_be(env._p)
        for step in range(STEPS[name]):
            observation, reward, *_ = env.step(action(name, step))
            episode.append((np.asarray(observation, float).tolist(), float(reward)))
        episodes.append(episode)
    return episodes


def _episode_on_our_data(name: str, discrete: bool) -> Episode:
    """These draw from Python's own random numbers."""
    module, _, kind = name.partition(":")
    env = getattr(importlib.import_module(f"pybullet_envs.{module}"), kind)(
        urdfRoot=str(OUR_DATA), isDiscrete=discrete
    )
    random.random = EvenChance().uniform  # type: ignore[assignment]
    episode = [(np.asarray(env.reset(), float).tolist(), 0.0)]
    for step in range(STEPS_ON_OUR_DATA):
        observation, reward, *_ = env.step(action_on_our_data(name, discrete, step))
        episode.append((np.asarray(observation, float).tolist(), float(reward)))
    return episode


if __name__ == "__main__":
    old_gym()
    without_a_server()
    recorded: dict[str, Any] = {name: _episodes_of_pybullet(name) for name in ACTIONS}
    for name, (_, choices) in ON_OUR_DATA.items():
        kinds = (False, True) if choices else (False,)
        recorded[name] = [_episode_on_our_data(name, discrete) for discrete in kinds]
    RECORD.write_text(json.dumps(recorded) + "\n")
