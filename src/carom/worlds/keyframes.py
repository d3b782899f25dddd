"""Resets of many worlds to keyframes."""

from __future__ import annotations

import numpy as np

from carom.engine.engine import Engine
from carom.scene.keyframes.keyframe import keyframes_of
from carom.scene.keyframes.state import changes, check_keyframe
from carom.world.world import World
from carom.worlds.batch import assign


def reset_to(scene: World, engine: Engine, name: str, worlds: np.ndarray) -> float:
    """Reset bodies to their keyframes of a name in some worlds; see `Worlds.reset_to`.

    Returns:
        The time of the keyframes.
    """
    keyframes = keyframes_of(list(scene.bodies.values()))
    if name not in keyframes:
        known = ", ".join(map(repr, keyframes)) or "none"
        raise KeyError(f"no body has a keyframe {name!r}; there are {known}")
    keyframe = keyframes[name]
    for body in keyframe.bodies:
        check_keyframe(body, keyframe.of(body))
        for change in changes(body, keyframe.of(body)):
            array = engine.arrays.state.numpy[change.field]
            array[worlds, change.rows] = change.values
    engine.status[worlds] = 0
    assign(engine.contact_arrays.cold_starts(worlds))
    return keyframe.time
