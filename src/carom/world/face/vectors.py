"""Controls and sensors of all bodies of a world as one vector each."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from carom.checks import Array

if TYPE_CHECKING:
    from numpy.typing import ArrayLike


class NamedVector(np.ndarray):
    """An array over named numbers, in many worlds with the world as first axis: `world.sensors["imu"]`.

    Attributes:
        names: A name for each number of the last axis.
        lower: Least values, (n,); -inf where there is no bound.
        upper: Greatest values.
        slices: Where the numbers of each actuator or sensor are, by its name.
    """

    names: list[str]
    lower: Array
    upper: Array
    slices: dict[str, slice]

    def __array_finalize__(self, made_from: Any) -> None:
        for name in ("names", "lower", "upper", "slices"):
            setattr(self, name, getattr(made_from, name, None))

    def __getitem__(self, key: Any) -> Any:
        """As of an array; a name gives the numbers of that actuator or sensor, (..., n)."""
        if isinstance(key, str):
            if key not in self.slices:
                raise KeyError(f"nothing is called {key!r} here; there are {', '.join(self.slices)}")
            return np.asarray(self)[..., self.slices[key]]
        return super().__getitem__(key)

    @classmethod
    def of(
        cls, numbers: Array, parts: Sequence[tuple[str, int]], lower: ArrayLike, upper: ArrayLike
    ) -> NamedVector:
        """Numbers with the names of their parts, each with its count."""
        made = np.asarray(numbers).view(cls)
        made.names, made.slices, place = [], {}, 0
        for name, count in parts:
            made.names += [name] if count == 1 else [f"{name}[{number}]" for number in range(count)]
            made.slices.setdefault(name, slice(place, place + count))
            place += count
        made.lower, made.upper = np.broadcast_to(lower, place), np.broadcast_to(upper, place)
        return made


def control_vector(bodies: Iterable[Any], count: int | None) -> NamedVector:
    """The controls of bodies in one world (None), or in `count`; a copy, which is read-only."""
    owners = [body for body in bodies if len(body.actuators)]
    empty = np.zeros(0 if count is None else (count, 0))
    numbers = np.concatenate([empty, *(np.asarray(body.actuators.controls) for body in owners)], axis=-1)
    specs = [spec for body in owners for spec in body.spec.actuators]
    bounds = np.array([spec.control_range for spec in specs], dtype=np.float64).reshape(-1, 2)
    made = NamedVector.of(numbers, [(spec.name, 1) for spec in specs], *bounds.T)
    made.flags.writeable = False
    return made


def set_controls(bodies: Iterable[Any], values: ArrayLike, count: int | None) -> None:
    """Set the controls of bodies; one number is for all."""
    owners = [body for body in bodies if len(body.actuators)]
    total = sum(len(body.actuators) for body in owners)
    given = np.asarray(values, dtype=np.float64)
    if given.ndim and given.shape not in ((total,), (count, total)):
        raise ValueError(f"controls must be one number or {total} of them, not shape {given.shape}")
    if not np.isfinite(given).all():
        raise ValueError(f"controls must be finite, not {values!r}")
    place = 0
    for body in owners:
        end = place + len(body.actuators)
        body.actuators.controls = given[..., place:end] if given.ndim else given
        place = end


def sensor_vector(bodies: Iterable[Any], count: int | None) -> NamedVector:
    """What all sensors of bodies show, one after the other; a copy."""
    parts: list[tuple[str, int]] = []
    numbers = [np.zeros(0 if count is None else (count, 0))]
    for body in bodies:
        if not len(body.sensors):
            continue
        shown = [np.asarray(sensor.read()) for sensor in body.sensors]
        parts += [(sensor.name, sensor.dim) for sensor in body.sensors]
        numbers += shown
    return NamedVector.of(np.concatenate(numbers, axis=-1), parts, -np.inf, np.inf)
