"""Infos of many environments, as Gymnasium's vector environments return them, and those of one of them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np


def own_infos(infos: Mapping[str, Any], world: int) -> dict[str, Any]:
    """The infos of one environment.

    Args:
        infos: Infos of all environments by name: arrays (num_envs, ...), dictionaries of such, or one value
            for all. `_name` is a mask of the environments that have the info `name`; without one, all have
            it.
        world: Index of the environment.

    Returns:
        Its own value of each info that it has, nested as in `infos`, without masks.
    """
    return {
        name: _own_value(value, world)
        for name, value in infos.items()
        if not _is_mask(infos, name) and _has(infos, name, world)
    }


def _is_mask(infos: Mapping[str, Any], name: str) -> bool:
    return name.startswith("_") and name[1:] in infos


def _has(infos: Mapping[str, Any], name: str, world: int) -> bool:
    mask = infos.get(f"_{name}")
    return mask is None or bool(mask[world])


def _own_value(value: Any, world: int) -> Any:
    if isinstance(value, Mapping):
        return own_infos(value, world)
    if isinstance(value, (list, tuple)) or (isinstance(value, np.ndarray) and value.ndim):
        return value[world]
    return value
