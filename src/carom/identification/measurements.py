"""Measurements of the motion of a robot's joints, at equal intervals."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from carom.checks import Array, finite

_UNEVEN = 0.02
_LEAST = 4
_PER_JOINT = ("velocities", "accelerations", "torques")


@dataclass(frozen=True, eq=False, slots=True)
class Measurements:
    """What was measured of n joints that can move, at N times; make one with `of`.

    Row k is the state at a time, and what drives the robot in the step that begins then.

    Attributes:
        time_step: Interval between rows [s].
        positions: [rad or m], (N, n).
        velocities: (N, n); None if they were not measured.
        accelerations: Means over the step that begins at the row, (N, n); likewise.
        torques: Forces of the drives on the joints [N m or N], (N, n), NaN where they are unknown; likewise.
        controls: Commands by the names of `World.linearize`, (N,) each.
    """

    time_step: float
    positions: Array
    velocities: Array | None
    accelerations: Array | None
    torques: Array | None
    controls: dict[str, Array]

    def __len__(self) -> int:
        return len(self.positions)

    @classmethod
    def of(
        cls,
        time: ArrayLike,
        positions: ArrayLike,
        *,
        velocities: ArrayLike | None = None,
        accelerations: ArrayLike | None = None,
        torques: ArrayLike | None = None,
        controls: Mapping[str, ArrayLike] | None = None,
    ) -> Measurements:
        """Check and collect arrays.

        Args:
            time: Times of the rows, equally spaced, (N,), or their interval, one number [s].
            positions: (N, n), or (N,) of one joint.
            velocities: Likewise.
            accelerations: Likewise.
            torques: Likewise.
            controls: (N,) each.

        Raises:
            ValueError: Shapes do not fit, a number is not finite, times are not equally spaced, or there are
                too few rows.
        """
        place = finite(positions, "positions")
        place = place[:, None] if place.ndim == 1 else place
        if place.ndim != 2 or len(place) < _LEAST:
            raise ValueError(f"positions must have shape (N, joints) with N at least {_LEAST}")
        given = {"velocities": velocities, "accelerations": accelerations, "torques": torques}
        found: dict[str, Array | None] = {}
        for name in _PER_JOINT:
            value = given[name]
            array = None if value is None else np.array(value, dtype=float)
            if array is not None:
                array = array[:, None] if array.ndim == 1 else array
                if array.shape != place.shape:
                    raise ValueError(f"{name} must have shape {place.shape}, not {array.shape}")
                if name != "torques":
                    finite(array, name)
            found[name] = array
        commands: dict[str, Array] = {}
        for name, value in (controls or {}).items():
            commands[name] = finite(value, name)
            if commands[name].shape != (len(place),):
                raise ValueError(f"{name} must have shape ({len(place)},), not {commands[name].shape}")
        return cls(
            _interval(finite(time, "time"), len(place)),
            place,
            found["velocities"],
            found["accelerations"],
            found["torques"],
            commands,
        )


def _interval(time: np.ndarray, count: int) -> float:
    if time.ndim == 0:
        if time <= 0.0:
            raise ValueError(f"the interval must be positive, not {time}")
        return float(time)
    if time.shape != (count,):
        raise ValueError(f"time must have shape ({count},), not {time.shape}")
    step = float(time[-1] - time[0]) / (count - 1)
    if not step > 0.0 or np.abs(np.diff(time) - step).max() > _UNEVEN * step:
        raise ValueError("times must grow by equal intervals: resample the log first")
    return step
