"""Measurements that sensors keep: those known only after a step, delayed ones, and those held for a time.

The memory of a sensor is a part of `State.sensor_memory`: how many measurements there are, then each with its
time, the newest first. So it is in snapshots, in files and in copies of worlds.
"""

from __future__ import annotations

import numpy as np

from carom.checks import Array
from carom.description.sensor import SensorSpec
from carom.errors import StateError

# Times that differ by less are the same [s].
_SAME_TIME = 1e-9


def entries(memory: Array, spec: SensorSpec) -> Array:
    """Measurements in the memories (worlds, numbers) of a sensor, newest first: (worlds, kept, 1 + dim)."""
    return memory[:, 1:].reshape(len(memory), spec.kept, 1 + spec.dim)


def due(memory: Array, spec: SensorSpec, times: Array) -> np.ndarray:
    """In which worlds it is time for a measurement, (worlds,)."""
    last = memory[:, 1]
    new = (memory[:, 0] == 0.0) | (times < last - _SAME_TIME)
    if spec.period == 0.0:
        return np.ones(len(memory), dtype=bool)
    now, before = ((when + _SAME_TIME) // spec.period for when in (times, last))
    return new | (now > before)


def push(memory: Array, spec: SensorSpec, times: Array, values: Array) -> Array:
    """The memories with one measurement more, which is there already if the time has not changed."""
    changed = memory.copy()
    # Time that runs backwards was set: what was measured before is of another run.
    changed[times < memory[:, 1] - _SAME_TIME, 0] = 0.0
    kept = entries(changed, spec)
    kept[:, 1:] = kept[:, :-1].copy()
    kept[:, 0, 0], kept[:, 0, 1:] = times, values
    changed[:, 1:] = kept.reshape(len(memory), -1)
    changed[:, 0] = np.minimum(changed[:, 0] + 1.0, spec.kept)
    return changed


def recall(memory: Array, spec: SensorSpec, times: Array) -> Array:
    """What the sensor shows, (worlds, dim): the newest measurement that is old enough, or else the oldest.

    Raises:
        StateError: More measurements are needed for the delay.
    """
    kept, number = entries(memory, spec), memory[:, 0].astype(int)
    there = np.arange(spec.kept)[None] < number[:, None]
    old = there & (kept[:, :, 0] <= (times - spec.delay)[:, None] + _SAME_TIME)
    found = old.any(axis=1)
    if spec.delay > 0.0 and (~found & (number == spec.kept)).any():
        raise StateError(
            f"sensor {spec.name!r} keeps {spec.kept} measurements, which do not reach back by its delay of "
            f"{spec.delay:g} s: give it more samples"
        )
    place = np.where(found, old.argmax(axis=1), np.maximum(number - 1, 0))
    return kept[np.arange(len(memory)), place, 1:]
