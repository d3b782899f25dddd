"""Observations of many environments: an array, or dictionaries and tuples of arrays."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np


def own_observation(observations: Any, world: int) -> Any:
    """The observation of one environment, a copy where it is an array."""
    if isinstance(observations, Mapping):
        return {name: own_observation(part, world) for name, part in observations.items()}
    if isinstance(observations, tuple):
        return tuple(own_observation(part, world) for part in observations)
    own = observations[world]
    return own.copy() if isinstance(own, np.ndarray) else own


def replace_observations(observations: Any, others: Any, worlds: np.ndarray) -> None:
    """Replace the observations of some environments, by index, by those among others of the same kind."""
    if isinstance(observations, Mapping):
        for name, part in observations.items():
            replace_observations(part, others[name], worlds)
    elif isinstance(observations, tuple):
        for part, other in zip(observations, others, strict=True):
            replace_observations(part, other, worlds)
    else:
        observations[worlds] = others[worlds]
