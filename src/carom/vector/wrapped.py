"""Checkpoints of environments in wrappers: what the wrappers have learnt is kept, too."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import gymnasium
import numpy as np

from carom.vector.checkpoints import attributes_of, read_checkpoint, set_attributes, write_checkpoint

_PARTS, _QUEUE, _SCALAR = "parts of", "queue", "scalar of"


def save(env: Any, path: str | Path) -> None:
    """Write a checkpoint of an environment and of all wrappers around it, such as `NormalizeObservation`.

    Of each wrapper it has the attributes that are numbers or arrays, queues of these, and objects of
    Gymnasium that consist of them, such as running means.

    Args:
        env: A `WorldsEnv`, in any number of Gymnasium's vector wrappers.
        path: The file.

    Raises:
        OSError: The file cannot be written; an existing file is unchanged.
        TypeError: There is no `WorldsEnv` inside.
    """
    inner = _inner(env)
    layers = [{"wrapper": type(layer).__name__, "state": _state(layer)} for layer in _layers(env)]
    write_checkpoint(path, {"inner": inner.checkpoint(), "wrappers": layers})


def restore(env: Any, path: str | Path) -> None:
    """Continue from a file of `save`, bit for bit, also in another process.

    Args:
        env: An environment of the same kind, in the same wrappers.
        path: The file.

    Raises:
        OSError: The file cannot be read.
        ValueError: It is not a checkpoint, or one of other environments or of other wrappers.
        TypeError: There is no `WorldsEnv` inside.
    """
    inner, saved = _inner(env), read_checkpoint(path)
    if "wrappers" not in saved:
        raise ValueError(
            f"{path} is a checkpoint of WorldsEnv.save: restore it by env.unwrapped.restore(path)"
        )
    layers = [*_layers(env)]
    names = [type(layer).__name__ for layer in layers]
    others = [each["wrapper"] for each in saved["wrappers"]]
    if names != others:
        raise ValueError(
            f"this is a checkpoint of the wrappers {others}, from the outside; these are {names}"
        )
    inner.resume(saved["inner"])
    for layer, each in zip(layers, saved["wrappers"], strict=True):
        _continue(layer, each["state"])


def _inner(env: Any) -> Any:
    inner = env.unwrapped
    if not hasattr(inner, "checkpoint"):
        raise TypeError(f"checkpoints are of a carom.vector.WorldsEnv in wrappers, not of {inner!r}")
    return inner


def _layers(env: Any) -> Iterator[Any]:
    """The wrappers, from the outside."""
    while env is not env.unwrapped:
        yield env
        env = env.env


def _state(layer: Any) -> dict[str, Any]:
    kept = _numbers(layer)
    for name, value in vars(layer).items():
        if name == "env" or isinstance(value, gymnasium.Space):
            continue
        if isinstance(value, deque):
            kept[name] = {_QUEUE: [np.asarray(part) for part in value]}
        elif type(value).__module__.partition(".")[0] == "gymnasium" and hasattr(value, "__dict__"):
            kept[name] = {_PARTS: _numbers(value)}
    return kept


def _numbers(thing: Any) -> dict[str, Any]:
    """Attributes that are numbers or arrays; numbers of NumPy keep their types, on which sums depend."""
    kept = attributes_of(thing)
    for name, value in vars(thing).items():
        if isinstance(value, np.generic):
            kept[name] = {_SCALAR: np.asarray(value)}
    return kept


def _continue(thing: Any, saved: Mapping[str, Any]) -> None:
    plain = {}
    for name, value in saved.items():
        kind = next(iter(value), "") if isinstance(value, dict) and len(value) == 1 else ""
        if kind == _PARTS:
            _continue(getattr(thing, name), value[_PARTS])
        elif kind == _SCALAR:
            setattr(thing, name, value[_SCALAR][()])
        elif kind == _QUEUE:
            queue: deque[Any] = getattr(thing, name)
            queue.clear()
            queue.extend(part[()] for part in value[_QUEUE])
        else:
            plain[name] = value
    set_attributes(thing, plain)
