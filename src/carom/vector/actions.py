"""Checking the actions of many environments."""

from __future__ import annotations

from typing import Any

import gymnasium
import numpy as np
from numpy.typing import ArrayLike


class ActionChecker:
    """Converts a policy's actions in `count` environments to checked arrays.

    Raises:
        ValueError: The action space of one environment is none of `Box`, `Discrete`, `MultiDiscrete` and
            `MultiBinary`.
    """

    def __init__(self, space: gymnasium.spaces.Space[Any], count: int) -> None:
        # The first choice and the one after the last, for each number of an action; None for doubles.
        self._choices: tuple[np.ndarray, np.ndarray] | None = None
        if isinstance(space, gymnasium.spaces.Discrete):
            self._choices = np.asarray(space.start), np.asarray(space.start + space.n)
        elif isinstance(space, gymnasium.spaces.MultiDiscrete):
            self._choices = np.asarray(space.start), np.asarray(space.start + space.nvec)
        elif isinstance(space, gymnasium.spaces.MultiBinary):
            self._choices = np.zeros(space.shape, int), np.full(space.shape, 2)
        elif not isinstance(space, gymnasium.spaces.Box):
            raise ValueError(
                f"the action space must be a Box, Discrete, MultiDiscrete or MultiBinary, not {space}"
            )
        self._shape: tuple[int, ...] = (count, *(space.shape or ()))

    def __call__(self, actions: ArrayLike) -> np.ndarray:
        """The actions as doubles, or as integers for a space of choices.

        Raises:
            ValueError: Their shape is wrong, or one is not finite or out of range.
        """
        given = np.asarray(actions)
        if given.shape != self._shape:
            raise ValueError(f"the actions have shape {given.shape}; they must have shape {self._shape}")
        if self._choices is not None:
            return self._chosen(given, *self._choices)
        values = given.astype(np.float64)
        good = np.isfinite(values)
        if not good.all():
            world = np.argwhere(~good)[0][0]
            raise ValueError(f"the action of environment {world} is not finite: {given[world]}")
        return values

    def _chosen(self, given: np.ndarray, first: np.ndarray, end: np.ndarray) -> np.ndarray:
        if not np.issubdtype(given.dtype, np.integer):
            raise ValueError(f"the actions must be integers, not {given.dtype}")
        wrong = np.argwhere((given < first) | (given >= end))
        if len(wrong):
            world, *place = wrong[0].tolist()
            number = f"number {place[0]} of " if place else ""
            place = tuple(place)
            raise ValueError(
                f"{number}the action of environment {world} is {given[(world, *place)]}; "
                f"there are {first[place]} to {end[place] - 1}"
            )
        return given
