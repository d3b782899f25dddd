"""Two episodes of each environment of the Minitaur, recorded with PyBullet and our files of the robot.

PYTHONPATH=. .oracle/bin/python tests/envs/record_minitaur.py     # needs gymnasium there, for its spaces
"""

from __future__ import annotations

import importlib
import json
import random
import sys
import types
from pathlib import Path
from typing import Any

import numpy as np
from tests.envs.record import OUR_DATA, Episodes, EvenChance, old_gym, without_a_server

RECORD = Path(__file__).with_name("minitaur.json")
STEPS = 12
KINDS: dict[str, dict[str, Any]] = {
    "bullet:MinitaurBulletEnv": {},
    "bullet:MinitaurBulletEnv pd": {"accurate_motor_model_enabled": False, "pd_control_enabled": True},
    "bullet:MinitaurBulletEnv position": {
        "accurate_motor_model_enabled": False,
        "env_randomizer": None,
        "on_rack": True,
    },
    "bullet:MinitaurBulletEnv duty": {
        "torque_control_enabled": True,
        "leg_model_enabled": False,
        "drift_weight": 0.5,
        "shake_weight": 0.25,
    },
    "bullet:MinitaurBulletEnv limited": {"motor_velocity_limit": 2.0, "on_rack": True},
    "bullet:MinitaurBulletDuckEnv": {},
    "minitaur.envs:MinitaurExtendedEnv": {},
    "minitaur.envs:MinitaurExtendedEnv all": {
        "history_length": 3,
        "history_include_states": True,
        "include_state_difference": True,
        "include_second_state_difference": True,
        "include_base_position": True,
        "include_leg_model": True,
    },
    "minitaur.envs:MinitaurReactiveEnv": {},
    "minitaur.envs:MinitaurReactiveEnv derpy": {
        "urdf_version": "derpy_v0",
        "pd_latency": 0.0025,
        "on_rack": True,
    },
    "minitaur.envs:MinitaurReactiveEnv rainbow": {"urdf_version": "rainbow_dash_v0"},
    "minitaur.envs:MinitaurBallGymEnv": {},
    "minitaur.envs:MinitaurTrottingEnv": {"use_angle_in_observation": True},
    "minitaur.envs:MinitaurStandGymEnv": {},
    "minitaur.envs:MinitaurAlternatingLegsEnv": {},
    "minitaur.envs:MinitaurFourLegStandEnv": {},
}
"""Environments by module and class, with a word for how they are made, and the keywords of that."""

ACTIONS = {"MinitaurBallGymEnv": 1, "MinitaurStandGymEnv": 1, "MinitaurFourLegStandEnv": 4}
"""How many numbers an action has, where it is not 8."""


def kind_of(name: str) -> tuple[str, str]:
    """The module and the class."""
    module, _, kind = name.split(maxsplit=1)[0].partition(":")
    return f"pybullet_envs.{module}", kind


def action(name: str, step: int) -> np.ndarray:
    _, kind = kind_of(name)
    wave = 0.2 * np.sin(0.3 * step + np.arange(ACTIONS.get(kind, 8)))
    if kind == "MinitaurAlternatingLegsEnv":
        # PyBullet loses the swings of every other leg.
        wave[[1, 3]] = 0.0
    return wave


def _without_protobuf() -> None:
    """No logs are written, so that their library need not be there."""
    module = types.ModuleType("logs")
    vars(module)["MinitaurEpisode"] = types.SimpleNamespace
    sys.modules["pybullet_envs.minitaur.envs.minitaur_logging_pb2"] = module
    logs = importlib.import_module("pybullet_envs.minitaur.envs.minitaur_logging")
    vars(logs)["preallocate_episode_proto"] = lambda *arguments: None


def _deal_evenly() -> None:
    """PyBullet's own randomizers draw from these."""
    chance = EvenChance()
    module: Any
    for module in (random, np.random):
        module.uniform = chance.uniform


def _record_of_pybullet(name: str) -> dict[str, Any]:
    module, kind = kind_of(name)
    env = getattr(importlib.import_module(module), kind)(**KINDS[name])
    spaces = [
        [space.low.tolist(), space.high.tolist()] for space in (env.action_space, env.observation_space)
    ]
    return {"spaces": spaces, "episodes": _episodes(env, name)}


def _episodes(env: Any, name: str) -> Episodes:
    episodes = []
    for _ in range(2):
        _deal_evenly()
        episode = [(np.asarray(env.reset(), float).round(7).tolist(), 0.0)]
        for step in range(STEPS):
            observation, reward, *_ = env.step(action(name, step))
            episode.append((np.asarray(observation, float).round(7).tolist(), float(reward)))
        episodes.append(episode)
    return episodes


if __name__ == "__main__":
    old_gym()
    vars(importlib.import_module("pybullet_data"))["getDataPath"] = lambda: str(OUR_DATA)
    importlib.import_module("pybullet_envs")
    _without_protobuf()
    without_a_server()
    _deal_evenly()
    RECORD.write_text(json.dumps({name: _record_of_pybullet(name) for name in KINDS}) + "\n")
