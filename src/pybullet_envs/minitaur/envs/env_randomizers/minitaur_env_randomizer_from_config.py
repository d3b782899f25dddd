"""Randomizer of the parameters in a configuration."""

from __future__ import annotations

from collections.abc import Callable
from types import FunctionType
from typing import Any

import numpy as np

from pybullet_envs.minitaur.envs.env_randomizer_base import EnvRandomizerBase
from pybullet_envs.minitaur.envs.env_randomizers import minitaur_env_randomizer_config

SIMULATION_TIME_STEP = 0.001

Draw = Callable[..., Any]
"""Draws one random number, or an array of a given length."""


class MinitaurEnvRandomizerFromConfig(EnvRandomizerBase):
    """Randomizer of a `MinitaurGymEnv`, at each `reset`."""

    def __init__(self, config: str | None = None) -> None:
        """Makes a randomizer.

        Args:
            config: Name of a function of `minitaur_env_randomizer_config`; by default `all_params`.

        Raises:
            ValueError: There is no such function, or it has unknown parameters.
        """
        ranges_of: Any = getattr(minitaur_env_randomizer_config, config or "all_params", None)
        if not isinstance(ranges_of, FunctionType):
            raise ValueError(f"Config {config} is not found.")
        self._ranges: dict[str, tuple[float, float]] = ranges_of()
        if unknown := self._ranges.keys() - _CHANGES.keys():
            raise ValueError(f"Config {config} has unknown parameters: {sorted(unknown)}.")

    def randomize_env(self, env: Any) -> None:
        """Randomises all parameters of the configuration."""
        for name, (low, high) in self._ranges.items():

            def draw(count: int | None = None, low: float = low, high: float = high) -> Any:
                return env.np_random.uniform(low, high, count)

            _CHANGES[name](env, draw)


def _masses(env: Any, draw: Draw) -> None:
    robot = env.minitaur
    robot.SetBaseMasses(np.multiply(draw(), robot.GetBaseMassesFromURDF()))
    robot.SetLegMasses(np.multiply(draw(), robot.GetLegMassesFromURDF()))


def _inertias(env: Any, draw: Draw) -> None:
    robot = env.minitaur
    robot.SetBaseInertias(np.multiply(draw(), robot.GetBaseInertiasFromURDF()))
    robot.SetLegInertias(np.multiply(draw(), robot.GetLegInertiasFromURDF()))


_CHANGES: dict[str, Callable[[Any, Draw], None]] = {
    "mass": _masses,
    "inertia": _inertias,
    "motor strength": lambda env, draw: env.minitaur.SetMotorStrengthRatios(draw(env.minitaur.num_motors)),
    "motor friction": lambda env, draw: env.minitaur.SetMotorViscousDamping(draw()),
    "control step": lambda env, draw: env.set_time_step(draw(), SIMULATION_TIME_STEP),
    "latency": lambda env, draw: env.minitaur.SetControlLatency(draw()),
    "lateral friction": lambda env, draw: env.minitaur.SetFootFriction(draw()),
    "restitution": lambda env, draw: env.minitaur.SetFootRestitution(draw()),
    "battery": lambda env, draw: env.minitaur.SetBatteryVoltage(draw()),
    "joint friction": lambda env, draw: env.minitaur.SetJointFriction(draw(env.minitaur.GetNumKneeJoints())),
}
