"""Checking the actions of many environments."""

from __future__ import annotations

from typing import Any

import gymnasium
import numpy as np
from numpy.typing import ArrayLike


class ActionChecker:
    """Converts a policy's actions in `count` environments to checked arrays.

    Raises:
        ValueError: The action space of one environment is neither a `Box` nor `Discrete`.
    """

    def __init__(self, space: gymnasium.spaces.Space[Any], count: int) -> None:
        if isinstance(space, gymnasium.spaces.Discrete):
            self._shape: tuple[int, ...] = (count,)
            self._choices = range(int(space.start), int(space.start + space.n))
        elif isinstance(space, gymnasium.spaces.Box):
            self._shape, self._choices = (count, *space.shape), None
        else:
            raise ValueError(f"the action space must be a Box or Discrete, not {space}")

    def __call__(self, actions: ArrayLike) -> np.ndarray:
        """The actions as doubles, or as integers for a `Discrete` space.

        Raises:
            ValueError: Their shape is wrong, or one is not finite or out of range.
        """
        given = np.asarray(actions)
        if given.shape != self._shape:
            raise ValueError(f"the actions have shape {given.shape}; they must have shape {self._shape}")
        if self._choices is not None:
            return self._chosen(given, self._choices)
        values = given.astype(np.float64)
        good = np.isfinite(values)
        if not good.all():
            world = np.argwhere(~good)[0][0]
            raise ValueError(f"the action of environment {world} is not finite: {given[world]}")
        return values

    def _chosen(self, given: np.ndarray, choices: range) -> np.ndarray:
        if not np.issubdtype(given.dtype, np.integer):
            raise ValueError(f"the actions must be integers, not {given.dtype}")
        wrong = np.flatnonzero((given < choices.start) | (given >= choices.stop))
        if len(wrong):
            raise ValueError(
                f"the action of environment {wrong[0]} is {given[wrong[0]]}; "
                f"there are {choices.start} to {choices.stop - 1}"
            )
        return given
