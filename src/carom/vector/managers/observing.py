"""Observations from terms: noise, limits, scales and history."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from carom.vector.checkpoints import Attributes
from carom.vector.delays import DelayLine
from carom.vector.managers.terms import Observation, shaped
from carom.vector.random import RandomSources

if TYPE_CHECKING:
    from carom.vector.worlds_env import WorldsEnv


class Observer(Attributes):
    """Puts observations together.

    Attributes:
        columns: Where in an observation each term is, by name.
        size: Length of an observation.

    Args:
        env: The environment, in any state.
        terms: The terms.

    Raises:
        ValueError: The result of a term has a wrong shape, or there are no terms.
    """

    def __init__(self, env: WorldsEnv, terms: Mapping[str, Observation]) -> None:
        if not terms:
            raise ValueError("a task needs at least one observation")
        self._terms = dict(terms)
        self._widths: dict[str, int] = {}
        self._lines: dict[str, DelayLine] = {}
        self.columns: dict[str, slice] = {}
        noises, first = [], 0
        for name, term in self._terms.items():
            value = np.asarray(term.function(env))
            if value.ndim not in (1, 2) or len(value) != env.num_envs:
                raise ValueError(
                    f"observation {name!r} returned an array of shape {value.shape}; it must have shape "
                    f"({env.num_envs},) or ({env.num_envs}, n)"
                )
            width = self._widths[name] = value.shape[1] if value.ndim == 2 else 1
            try:
                noises.append(np.broadcast_to(np.asarray(term.noise, float), (width,)))
                np.broadcast_to(np.asarray(term.scale, float), (width,))
            except ValueError:
                raise ValueError(
                    f"observation {name!r}: noise and scale must be one number or {width}"
                ) from None
            line = DelayLine(
                env.num_envs, (width,), term.delay, history=term.history, name=f"observation {name!r}"
            )
            if term.history > 1 or term.delay != 0:
                self._lines[name] = line
            self.columns[name] = slice(first, first + width * term.history)
            first += width * term.history
        self.size: int = first
        self._noise = np.concatenate(noises)
        # The step of its episode in which each world was remembered last.
        self._step = np.full(env.num_envs, -1, dtype=np.int64)

    def forget(self, worlds: np.ndarray, random: RandomSources) -> None:
        """Forget the history of worlds whose episodes begin, and choose their delays."""
        self._step[worlds] = -1
        for line in self._lines.values():
            line.start(worlds, random)

    def __call__(self, env: WorldsEnv) -> np.ndarray:
        """The observations, (num_envs, size)."""
        values = []
        for name, term in self._terms.items():
            width, value = self._widths[name], np.asarray(term.function(env))
            # A term of one number may be (num_envs,) as well as (num_envs, 1).
            shape = (env.num_envs,) if width == 1 and value.ndim == 1 else (env.num_envs, width)
            values.append(shaped(value, shape, "observation", name).reshape(env.num_envs, width))
        self._add_noise(env, values)
        is_new, begins = self._step != env.episode_steps, self._step < 0
        found = np.empty((env.num_envs, self.size), dtype=np.float32)
        for (name, term), value in zip(self._terms.items(), values, strict=True):
            limited = value if term.clip is None else np.clip(value, *term.clip)
            scaled = limited * term.scale
            if name in self._lines:
                line, going_on = self._lines[name], is_new & ~begins
                line.fill(begins, scaled[begins])
                line.push(scaled[going_on], going_on)
                scaled = line.history.reshape(env.num_envs, -1)
            found[:, self.columns[name]] = scaled
        self._step[:] = env.episode_steps
        return found

    def _add_noise(self, env: WorldsEnv, values: list[np.ndarray]) -> None:
        if not self._noise.any():
            return
        noise = env.random.uniform(np.arange(env.num_envs), -1.0, 1.0, len(self._noise)) * self._noise
        first = 0
        for place, value in enumerate(values):
            values[place] = value + noise[:, first : first + value.shape[1]]
            first += value.shape[1]
