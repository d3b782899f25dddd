"""Resets of many worlds to keyframes."""

from __future__ import annotations

from typing import Any

import numpy as np

from carom.engine.engine import Engine
from carom.scene.keyframes.keyframe import keyframes_of
from carom.scene.keyframes.state import changes, check_keyframe
from carom.world.world import World

Writes = list[tuple[Any, Any, Any]]
"""What `carom.worlds.batch.assign` writes."""


def resets_to(scene: World, engine: Engine, name: str, worlds: np.ndarray) -> tuple[Writes, float]:
    """What resets bodies to their keyframes of a name in some worlds, and the time of these.

    See `Worlds.reset_to`.
    """
    keyframes = keyframes_of(list(scene.bodies.values()))
    if name not in keyframes:
        known = ", ".join(map(repr, keyframes)) or "none"
        raise KeyError(f"no body has a keyframe {name!r}; there are {known}")
    keyframe, state = keyframes[name], engine.arrays.state.numpy
    writes: Writes = [(engine.status, worlds, 0), engine.contact_arrays.cold_starts(worlds)]
    for body in keyframe.bodies:
        check_keyframe(body, keyframe.of(body))
        parts = changes(body, keyframe.of(body))
        writes += [(state[part.field], (worlds, part.rows), part.values) for part in parts]
    return writes, keyframe.time
