"""The environments for scripts that use `gym`, the predecessor of Gymnasium.

Each is the one for Gymnasium behind an adapter. `reset` returns the observation alone and `step` four values,
as in PyBullet; but `gym.make` of version 0.26 needs those of Gymnasium: an observation and a dictionary, and
five values.
"""

from __future__ import annotations

import sys
from abc import ABCMeta
from collections.abc import Iterable
from functools import partial
from importlib import import_module
from importlib.util import find_spec
from types import SimpleNamespace
from typing import Any

import numpy as np

INSTALLED = find_spec("gym") is not None
_FIRST_WITH_FIVE_VALUES = (0, 26)

Environment = tuple[str, str, int, float | None]


def is_asked_for() -> bool:
    """Whether the script has imported gym."""
    return "gym" in sys.modules


def register_all(environments: Iterable[Environment]) -> None:
    """Registers environments in gym, unless there are some of their names.

    Each has a name, its module and class, the greatest number of steps, and a reward that solves it.
    """
    registration = import_module("gym.envs.registration")
    # A dictionary in newer versions, an object that has one in older ones.
    known = getattr(registration.registry, "env_specs", registration.registry)
    for name, place, steps, solved in environments:
        if name not in known:
            make = partial(make_adapted, place)
            options = {"max_episode_steps": steps, "reward_threshold": solved}
            registration.register(name, entry_point=make, **options)


def make_adapted(place: str, **arguments: Any) -> Any:
    """The environment of a module and class of this package, with the interface of the gym installed."""
    gym = import_module("gym")

    module, _, name = place.partition(":")
    env = getattr(import_module(f"pybullet_envs.{module}"), name)(**arguments)
    version = tuple(int(part) for part in gym.__version__.split(".")[:2])
    return adapted(getattr(env, "adaptee", env), has_five_values=version >= _FIRST_WITH_FIVE_VALUES)


def adapted(env: Any, *, has_five_values: bool) -> Any:
    """An environment for Gymnasium as one of gym, whose other attributes are those of the first.

    Without five values, `step` returns four, and `reset` the observation alone.
    """
    gym = import_module("gym")

    class Adapted(gym.Env):
        adaptee = env
        metadata = env.metadata | {"render.modes": env.metadata["render_modes"]}
        action_space = _space(env.action_space)
        observation_space = _space(env.observation_space)

        def __getattr__(self, name: str) -> Any:
            if name.startswith("__"):
                raise AttributeError(name)
            return getattr(env, name)

        @property
        def render_mode(self) -> str | None:
            return env.render_mode

        @property
        def np_random(self) -> Any:
            return env.np_random

        def reset(self, *, seed: int | None = None, options: Any = None, return_info: bool = False) -> Any:
            observation, info = env.reset(seed=seed, options=options)
            return (observation, info) if has_five_values or return_info else observation

        def step(self, action: Any) -> tuple[Any, ...]:
            observation, reward, terminated, truncated, info = env.step(action)
            if has_five_values:
                return observation, reward, terminated, truncated, info
            if truncated and not terminated:
                info = {**info, "TimeLimit.truncated": True}
            return observation, reward, terminated or truncated, info

        def seed(self, seed: int | None = None) -> list[int]:
            return env.seed(seed)

        def render(self, mode: str | None = None) -> Any:
            return env.render() if mode is None else env.render(mode)

        def close(self) -> None:
            env.close()

    Adapted.__name__ = Adapted.__qualname__ = type(env).__name__
    return Adapted()


def _space(space: Any) -> Any:
    """A space of Gymnasium as one of gym."""
    spaces = import_module("gym.spaces")

    if isinstance(space, spaces.Space):
        return space
    if hasattr(space, "n"):
        return spaces.Discrete(int(space.n))
    return spaces.Box(space.low, space.high, dtype=space.dtype.type)


class _Adapting(ABCMeta):
    """Makes environments with PyBullet's interface, of four values, where scripts call their classes."""

    def __call__(cls, *arguments: Any, **keywords: Any) -> Any:
        return adapted(super().__call__(*arguments, **keywords), has_five_values=False)


class _Env(metaclass=_Adapting):
    """What environments need of `gymnasium.Env`, where only gym is installed."""

    _random: np.random.Generator | None = None

    def __class_getitem__(cls, item: Any) -> Any:
        return cls

    @property
    def np_random(self) -> np.random.Generator:
        """Random numbers, made when they are first needed."""
        if self._random is None:
            self._random, _ = seeded()
        return self._random

    @np_random.setter
    def np_random(self, value: np.random.Generator) -> None:
        self._random = value

    def reset(self, *, seed: int | None = None, options: Any = None) -> Any:
        """Seeds the random numbers, if there is a seed."""
        if seed is not None:
            self._random, _ = seeded(seed)

    @property
    def unwrapped(self) -> Any:
        """The environment itself."""
        return self


def seeded(seed: int | None = None) -> tuple[np.random.Generator, Any]:
    """Random numbers and their seed, as from `gymnasium.utils.seeding.np_random`."""
    sequence = np.random.SeedSequence(seed)
    return np.random.Generator(np.random.PCG64(sequence)), sequence.entropy


def stand_in() -> Any:
    """The parts of Gymnasium that the environments use, made of gym."""
    gym = import_module("gym")

    seeding = SimpleNamespace(np_random=seeded)
    return SimpleNamespace(Env=_Env, spaces=gym.spaces, utils=SimpleNamespace(seeding=seeding), make=gym.make)
