"""Infos of many environments, as Gymnasium's vector environments return them, and those of one of them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
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


def batched_infos(infos: Mapping[str, Any], count: int, which: np.ndarray) -> dict[str, Any]:
    """Infos with the masks that Gymnasium's vector environments have.

    Args:
        infos: As `WorldsEnv.infos` returns them: by name, an array or list with the environments in front, a
            dictionary of such, or one value for all. Masks that are there already stay.
        count: Number of environments.
        which: Mask of the environments that have these infos, (count,).

    Raises:
        ValueError: An array or list has another length.
    """
    found: dict[str, Any] = {}
    for name, value in infos.items():
        if _is_mask(infos, name):
            continue
        found[name] = _batched(name, value, count, which)
        own = infos.get(f"_{name}")
        found[f"_{name}"] = which.copy() if own is None else np.asarray(own, dtype=bool) & which
    return found


def _batched(name: str, value: Any, count: int, which: np.ndarray) -> Any:
    if isinstance(value, Mapping):
        return batched_infos(value, count, which)
    if isinstance(value, (list, tuple)) or (isinstance(value, np.ndarray) and value.ndim):
        if len(value) != count:
            raise ValueError(
                f"the info {name!r} has {len(value)} entries; it must have one for each of the {count} "
                "environments, or be a single value"
            )
        return value if isinstance(value, np.ndarray) else _array(value)
    return _array([value] * count)


def _array(values: Sequence[Any]) -> np.ndarray:
    """Values of environments as an array: of numbers, or of objects if they are anything else."""
    if all(isinstance(value, (bool, int, float, np.generic)) for value in values):
        return np.array(values)
    array = np.full(len(values), None, dtype=object)
    for place, value in enumerate(values):
        array[place] = value
    return array
