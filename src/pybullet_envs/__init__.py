"""Carom's version of PyBullet's environments for Gymnasium: `gymnasium.make("AntBulletEnv-v0")`.

Importing this package registers them if Gymnasium is installed. Observations, actions, rewards and ends of
episodes are PyBullet's; the interface is Gymnasium's, whose `step` returns five values. Robots and other
parts work without Gymnasium.

Where gym, its predecessor, is installed instead, or was imported before, `gym.make` knows the environments as
well, with the interface of that version of gym.
"""

from __future__ import annotations

from functools import partial
from typing import Any, NoReturn

import pybullet as p
from pybullet._absent import announce
from pybullet_envs import _old_gym
from pybullet_envs._absent_modules import ABSENT
from pybullet_envs._gymnasium import INSTALLED, gymnasium, require_gymnasium

__all__ = ["getList", "register"]

_SWINGUP = "gym_pendulum_envs:InvertedPendulumSwingupBulletEnv"
_FLAGRUN_HARDER = "gym_locomotion_envs:HumanoidFlagrunHarderBulletEnv"
# Name, module and class, maximum number of steps, and reward threshold.
_ENVIRONMENTS: tuple[tuple[str, str, int, float | None], ...] = (
    ("CartPoleBulletEnv-v1", "bullet.cartpole_bullet:CartPoleBulletEnv", 200, 190.0),
    ("CartPoleContinuousBulletEnv-v0", "bullet.cartpole_bullet:CartPoleContinuousBulletEnv", 200, 190.0),
    ("MinitaurBulletEnv-v0", "bullet.minitaur_gym_env:MinitaurBulletEnv", 1000, 15.0),
    ("MinitaurBulletDuckEnv-v0", "bullet.minitaur_duck_gym_env:MinitaurBulletDuckEnv", 1000, 5.0),
    ("MinitaurExtendedEnv-v0", "minitaur.envs:MinitaurExtendedEnv", 1000, 5.0),
    ("MinitaurReactiveEnv-v0", "minitaur.envs:MinitaurReactiveEnv", 1000, 5.0),
    ("MinitaurBallGymEnv-v0", "minitaur.envs:MinitaurBallGymEnv", 1000, 5.0),
    ("MinitaurTrottingEnv-v0", "minitaur.envs:MinitaurTrottingEnv", 1000, 5.0),
    ("MinitaurStandGymEnv-v0", "minitaur.envs:MinitaurStandGymEnv", 1000, 5.0),
    ("MinitaurAlternatingLegsEnv-v0", "minitaur.envs:MinitaurAlternatingLegsEnv", 1000, 5.0),
    ("MinitaurFourLegStandEnv-v0", "minitaur.envs:MinitaurFourLegStandEnv", 1000, 5.0),
    ("RacecarBulletEnv-v0", "bullet.racecarGymEnv:RacecarGymEnv", 1000, 5.0),
    ("RacecarZedBulletEnv-v0", "bullet.racecarZEDGymEnv:RacecarZEDGymEnv", 1000, 5.0),
    ("KukaBulletEnv-v0", "bullet.kukaGymEnv:KukaGymEnv", 1000, 5.0),
    ("KukaCamBulletEnv-v0", "bullet.kukaCamGymEnv:KukaCamGymEnv", 1000, 5.0),
    (
        "KukaDiverseObjectGrasping-v0",
        "bullet.kuka_diverse_object_gym_env:KukaDiverseObjectEnv",
        1000,
        5.0,
    ),
    ("InvertedPendulumBulletEnv-v0", "gym_pendulum_envs:InvertedPendulumBulletEnv", 1000, 950.0),
    ("InvertedDoublePendulumBulletEnv-v0", "gym_pendulum_envs:InvertedDoublePendulumBulletEnv", 1000, 9100.0),
    (
        "InvertedPendulumSwingupBulletEnv-v0",
        _SWINGUP,
        1000,
        800.0,
    ),
    ("ReacherBulletEnv-v0", "gym_manipulator_envs:ReacherBulletEnv", 150, 18.0),
    ("PusherBulletEnv-v0", "gym_manipulator_envs:PusherBulletEnv", 150, 18.0),
    ("ThrowerBulletEnv-v0", "gym_manipulator_envs:ThrowerBulletEnv", 100, 18.0),
    ("Walker2DBulletEnv-v0", "gym_locomotion_envs:Walker2DBulletEnv", 1000, 2500.0),
    ("HalfCheetahBulletEnv-v0", "gym_locomotion_envs:HalfCheetahBulletEnv", 1000, 3000.0),
    ("AntBulletEnv-v0", "gym_locomotion_envs:AntBulletEnv", 1000, 2500.0),
    ("HopperBulletEnv-v0", "gym_locomotion_envs:HopperBulletEnv", 1000, 2500.0),
    ("HumanoidBulletEnv-v0", "gym_locomotion_envs:HumanoidBulletEnv", 1000, None),
    ("HumanoidFlagrunBulletEnv-v0", "gym_locomotion_envs:HumanoidFlagrunBulletEnv", 1000, 2000.0),
    ("HumanoidFlagrunHarderBulletEnv-v0", _FLAGRUN_HARDER, 1000, None),
)

# Environments with a vector version: its module and class in `pybullet_envs.vector`.
_VECTORS = {
    "CartPoleBulletEnv-v1": "cartpole:CartPoleVectorEnv",
    "CartPoleContinuousBulletEnv-v0": "cartpole:CartPoleContinuousVectorEnv",
    "KukaBulletEnv-v0": "kuka:KukaVectorEnv",
    "InvertedPendulumBulletEnv-v0": "pendula:InvertedPendulumVectorEnv",
    "InvertedPendulumSwingupBulletEnv-v0": "pendula:InvertedPendulumSwingupVectorEnv",
    "InvertedDoublePendulumBulletEnv-v0": "pendula:InvertedDoublePendulumVectorEnv",
    "ReacherBulletEnv-v0": "arms:ReacherVectorEnv",
    "PusherBulletEnv-v0": "arms:PusherVectorEnv",
    "HopperBulletEnv-v0": "walkers:HopperVectorEnv",
    "Walker2DBulletEnv-v0": "walkers:Walker2DVectorEnv",
    "HalfCheetahBulletEnv-v0": "walkers:HalfCheetahVectorEnv",
    "AntBulletEnv-v0": "walkers:AntVectorEnv",
    "HumanoidBulletEnv-v0": "walkers:HumanoidVectorEnv",
}

# PyBullet's other names; they are registered so that the error gives the reason.
_DEEP_MIMIC = ("HumanoidDeepMimicBackflipBulletEnv-v1", "HumanoidDeepMimicWalkBulletEnv-v1")
_NEEDS_MOTIONS = "it imitates recorded motions of people, which Carom may not distribute"


def _unavailable(name: str, **keywords: Any) -> NoReturn:
    raise p.error(
        f"{name} is not available in this version of Carom: {_NEEDS_MOTIONS}; available are: {_names()}"
    )


def _names() -> str:
    return ", ".join(name for name, *_ in _ENVIRONMENTS)


def _register_all() -> None:
    for name in _DEEP_MIMIC:
        if name not in gymnasium.registry:
            gymnasium.register(name, entry_point=partial(_unavailable, name))
    for name, place, steps, solved in _ENVIRONMENTS:
        if name not in gymnasium.registry:
            gymnasium.register(
                name,
                entry_point=f"pybullet_envs.{place}",
                vector_entry_point=f"pybullet_envs.vector.{_VECTORS[name]}" if name in _VECTORS else None,
                max_episode_steps=steps,
                reward_threshold=solved,
            )


announce(__name__, ABSENT)
if INSTALLED:
    _register_all()
if _old_gym.INSTALLED and (_old_gym.is_asked_for() or not INSTALLED):
    _old_gym.register_all(_ENVIRONMENTS)


def register(id: str, *args: Any, **kvargs: Any) -> None:
    """Registers an environment in Gymnasium, unless there is one of that name."""
    require_gymnasium()
    if id not in gymnasium.registry:
        gymnasium.register(id, *args, **kvargs)


def getList() -> list[str]:
    """Names of the environments, each with `- ` in front."""
    return [f"- {name}" for name, *_ in _ENVIRONMENTS]
