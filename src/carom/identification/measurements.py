"""Measurements of the motion of a robot's joints, at equal intervals."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike

from carom.checks import Array, finite

_UNEVEN = 0.02
_LEAST = 4
_PER_JOINT = ("velocities", "accelerations", "torques")
_OF_BASE = {"base_positions": 3, "base_orientations": 4, "base_velocities": 6}
_WRENCH = 6


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
        base_positions: Of the link frame of a free base [m], world axes, (N, 3); None of a fixed one.
        base_orientations: Its quaternions (x, y, z, w), of length 1, (N, 4); likewise.
        base_velocities: Linear velocity of the base's centre of mass [m/s] and angular one [rad/s], in world
            axes, (N, 6); None if they were not measured.
        forces: By the names of links: forces [N] and torques [N m] from outside in the step that begins at
            the row, at the origin of the link frame, in world axes, (N, 6); none on other links. None if they
            are unknown: then nothing follows from how a free base moves.
        sensors: By the names of sensors of the robot: what they showed at the time of the row, that is after
            the step that ended there, (N, dim); NaN where it is unknown.
    """

    time_step: float
    positions: Array
    velocities: Array | None
    accelerations: Array | None
    torques: Array | None
    controls: dict[str, Array]
    base_positions: Array | None = None
    base_orientations: Array | None = None
    base_velocities: Array | None = None
    forces: dict[str, Array] | None = None
    sensors: dict[str, Array] = field(default_factory=dict[str, Array])

    def __len__(self) -> int:
        return len(self.positions)

    @classmethod
    def of(
        cls,
        time: ArrayLike,
        positions: ArrayLike | None = None,
        *,
        velocities: ArrayLike | None = None,
        accelerations: ArrayLike | None = None,
        torques: ArrayLike | None = None,
        controls: Mapping[str, ArrayLike] | None = None,
        base_positions: ArrayLike | None = None,
        base_orientations: ArrayLike | None = None,
        base_velocities: ArrayLike | None = None,
        forces: Mapping[str, ArrayLike] | None = None,
        sensors: Mapping[str, ArrayLike] | None = None,
    ) -> Measurements:
        """Check and collect arrays.

        Args:
            time: Times of the rows, equally spaced, (N,), or their interval, one number [s].
            positions: (N, n), or (N,) of one joint; None of a robot without joints.
            velocities: Likewise.
            accelerations: Likewise.
            torques: Likewise.
            controls: (N,) each.
            base_positions: (N, 3), with `base_orientations`.
            base_orientations: (N, 4), of any length but 0.
            base_velocities: (N, 6).
            forces: (N, 6) each, or (N, 3) without torques.
            sensors: (N, dim) each, or (N,).

        Raises:
            ValueError: Shapes do not fit, a number is not finite, times are not equally spaced, or there are
                too few rows.
        """
        base = _base(
            {
                "base_positions": base_positions,
                "base_orientations": base_orientations,
                "base_velocities": base_velocities,
            }
        )
        if positions is None:
            if base["base_positions"] is None:
                raise ValueError("a log needs positions")
            positions = np.zeros((len(base["base_positions"]), 0))
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
        for name, array in base.items():
            if array is not None and len(array) != len(place):
                raise ValueError(f"{name} must have {len(place)} rows, as positions, not {len(array)}")
        return cls(
            _interval(finite(time, "time"), len(place)),
            place,
            found["velocities"],
            found["accelerations"],
            found["torques"],
            commands,
            base["base_positions"],
            base["base_orientations"],
            base["base_velocities"],
            None
            if forces is None
            else {name: _wrenches(name, it, len(place)) for name, it in forces.items()},
            {name: _readings(name, value, len(place)) for name, value in (sensors or {}).items()},
        )


def _base(given: Mapping[str, ArrayLike | None]) -> dict[str, Array | None]:
    found: dict[str, Array | None] = {}
    for name, value in given.items():
        array = None if value is None else finite(value, name)
        if array is not None and (array.ndim != 2 or array.shape[1] != _OF_BASE[name]):
            raise ValueError(f"{name} must have shape (N, {_OF_BASE[name]}), not {array.shape}")
        found[name] = array
    if (found["base_positions"] is None) != (found["base_orientations"] is None):
        raise ValueError("base_positions and base_orientations come together")
    turns = found["base_orientations"]
    if turns is not None:
        sizes = np.linalg.norm(turns, axis=1, keepdims=True)
        if not sizes.all():
            raise ValueError(f"base_orientations: row {int(np.argmin(sizes))} is 0, so it is no orientation")
        found["base_orientations"] = turns / sizes
    return found


def _wrenches(name: str, value: ArrayLike, count: int) -> Array:
    """Forces and torques (N, 6) on a link."""
    array = finite(value, f"forces on {name!r}")
    if array.shape not in ((count, 3), (count, _WRENCH)):
        raise ValueError(
            f"forces on {name!r} must have shape ({count}, 6) or ({count}, 3), not {array.shape}"
        )
    return np.concatenate([array, np.zeros((count, _WRENCH - array.shape[1]))], axis=1)


def _readings(name: str, value: ArrayLike, count: int) -> Array:
    array = np.array(value, dtype=float)
    array = array[:, None] if array.ndim == 1 else array
    if array.ndim != 2 or len(array) != count:
        raise ValueError(f"sensor {name!r} must have shape ({count}, dim), not {array.shape}")
    return array


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
