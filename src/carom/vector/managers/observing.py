"""Observations from terms: noise, limits, scales and history."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import gymnasium
import numpy as np

from carom.vector.checkpoints import Attributes
from carom.vector.delays import DelayLine
from carom.vector.managers.noises import Noise
from carom.vector.managers.terms import ImageGroup, Observation, shaped
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
        # Models of noise, and the numbers that they keep for an episode.
        self._models: dict[str, Noise] = {}
        self._kept: dict[str, np.ndarray] = {}
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
            plain: Any = term.noise
            if isinstance(term.noise, Noise):
                self._models[name], plain = term.noise, 0.0
                with env.random.only(np.zeros(0, dtype=np.int64)):
                    self._kept[name] = term.noise.episode(env.random, np.arange(env.num_envs), width)
            try:
                noises.append(np.broadcast_to(np.asarray(plain, float), (width,)))
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
        for name, model in self._models.items():
            self._kept[name][worlds] = model.episode(random, worlds, self._widths[name])

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
        for place, name in enumerate(self._terms):
            if name in self._models:
                values[place] = self._models[name](values[place], self._kept[name], env.random)
        if not self._noise.any():
            return
        noise = env.random.uniform(np.arange(env.num_envs), -1.0, 1.0, len(self._noise)) * self._noise
        first = 0
        for place, value in enumerate(values):
            values[place] = value + noise[:, first : first + value.shape[1]]
            first += value.shape[1]

    def space(self) -> gymnasium.Space[Any]:
        """The space of the observation of one environment."""
        endless = np.full(self.size, np.inf, np.float32)
        return gymnasium.spaces.Box(-endless, endless)


class Images(Attributes):
    """Puts the images of a camera together, for a group of observations."""

    def __init__(self, group: ImageGroup) -> None:
        if group.kind not in ("colour", "depth"):
            raise ValueError(f"kind of an ImageGroup must be 'colour' or 'depth', not {group.kind!r}")
        self._group = group

    def forget(self, worlds: np.ndarray, random: RandomSources) -> None:
        """It has no memory."""

    def __call__(self, env: WorldsEnv) -> np.ndarray:
        """The images, (num_envs, height, width, 3 or 1)."""
        images = env.worlds.images(self._group.camera)
        if self._group.kind == "colour":
            return images.colour
        return np.minimum(images.depth, np.float32(self._group.farthest))[..., np.newaxis]

    def space(self) -> gymnasium.Space[Any]:
        """The space of the observation of one environment."""
        size = (self._group.camera.height, self._group.camera.width)
        if self._group.kind == "colour":
            return gymnasium.spaces.Box(0, 255, (*size, 3), np.uint8)
        return gymnasium.spaces.Box(0.0, self._group.farthest, (*size, 1), np.float32)


class Groups(Attributes):
    """Puts groups of observations together, as a dictionary.

    Attributes:
        groups: What puts each together, by name.
    """

    def __init__(self, env: WorldsEnv, groups: Mapping[str, Mapping[str, Observation] | ImageGroup]) -> None:
        self.groups: dict[str, Observer | Images] = {
            name: Images(group) if isinstance(group, ImageGroup) else Observer(env, group)
            for name, group in groups.items()
        }

    def forget(self, worlds: np.ndarray, random: RandomSources) -> None:
        """Forget the history of worlds whose episodes begin."""
        for group in self.groups.values():
            group.forget(worlds, random)

    def __call__(self, env: WorldsEnv) -> dict[str, np.ndarray]:
        """The observations of each group."""
        return {name: group(env) for name, group in self.groups.items()}

    def space(self) -> gymnasium.Space[Any]:
        """The space of the observation of one environment."""
        return gymnasium.spaces.Dict({name: group.space() for name, group in self.groups.items()})


def observer_of(env: WorldsEnv, observations: Mapping[str, Any]) -> Observer | Groups:
    """What puts the observations of a task together.

    Raises:
        ValueError: Terms and groups are mixed, or a term returns a wrong shape.
    """
    single = [isinstance(each, Observation) for each in observations.values()]
    if all(single):
        return Observer(env, observations)
    if any(single):
        raise ValueError("observations are either terms, or groups of terms such as 'policy' and 'critic'")
    return Groups(env, observations)
