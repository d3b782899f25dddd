"""The sensors of a body read together, by one launch of a kernel over all worlds.

The kernel measures what follows from the present and from the last step. What is rare is read one sensor at a
time: sensors with a clock, along rays, of tendons, contacts and distances.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from carom.checks import Array
from carom.description.sensor import OF_STEPS, SensorKind, SensorSpec
from carom.native.kernels import sensors_kernel
from carom.scene.sensors.noise import Gaussians
from carom.scene.sensors.reading import reading
from carom.scene.sensors.source import Source
from carom.scene.sensors.table import OTHERS, SensorRows, bounds_of, is_in_table

if TYPE_CHECKING:
    from carom.scene.core.body_core import BodyCore


# Kinds that are read alone without a kernel. To one that reads a clock the time would have to be given first.
_ALONE = (SensorKind.CLOCK, *OTHERS)
# In place of an index.
_ALL = -1


class Together:
    """Reads the sensors of a body, or one of them.

    Attributes:
        slices: The place of each sensor among the numbers of a world; None for one that is read alone.

    Args:
        source: The worlds.
        body: The body.
        indices: The sensors.
    """

    def __init__(self, source: Source, body: BodyCore, indices: Sequence[int]) -> None:
        self._body = body
        specs = body.spec.sensors
        taken = [index for index in indices if is_in_table(body, specs[index])]
        self._rows = SensorRows(source, body, taken)
        self.slices: list[slice | None] = [None] * len(specs)
        for index, place in zip(taken, self._rows.slices, strict=True):
            self.slices[index] = place
        self._alone = [index for index in indices if self.slices[index] is None]
        self._of_steps = [index for index in taken if specs[index].kind in OF_STEPS]
        self._noise = _Noise(body, {index: specs[index] for index in taken}, self.slices)
        clocks = [self.slices[index] for index in taken if specs[index].kind is SensorKind.CLOCK]
        self._clocks = [place.start for place in clocks if place is not None]
        self._run = source.reader(body, sensors_kernel, self._rows.table, self._rows.numbers)

    def values(self, source: Source) -> tuple[Array, dict[int, Array]]:
        """What `shown` gives, and what sensors show that are read alone, (worlds, dim) each."""
        others = {index: reading(source, self._body, index) for index in self._alone}
        return self.shown(source), others

    def shown(self, source: Source) -> Array:
        """The numbers of sensors in each world, (worlds, width): of one they are the columns `slices`."""
        rows, body = self._rows, self._body
        if not rows.slices:
            return rows.values
        rows.given[0] = source.parameters.substep_time
        if self._clocks:
            rows.values[:, self._clocks] = source.times[:, None]
        if rows.limits:
            rows.find_limits()
        self._run()
        shown = rows.values.copy()
        if self._noise.is_any:
            self._noise.add(shown, source)
        if rows.of_steps and not (source.state("tree_last_step")[:, body.rows.tree, 3] > 0.0).all():
            # Somewhere there was no step since the body was reset.
            for index in self._of_steps:
                place = self.slices[index]
                if place is not None:
                    shown[:, place] = reading(source, body, index)
        return shown

    def read(self, source: Source) -> list[Array]:
        """What each sensor of the body shows in each world, (worlds, dim) each."""
        shown, others = self.values(source)
        places = enumerate(self.slices)
        return [others[index] if place is None else shown[:, place] for index, place in places]


class _Noise:
    """Noise of some sensors, and the bounds of what they show.

    Attributes:
        is_any: Whether one of them has noise.
    """

    def __init__(self, body: BodyCore, specs: dict[int, SensorSpec], slices: list[slice | None]) -> None:
        noisy = {index: spec for index, spec in specs.items() if spec.noise > 0.0}
        places = [slices[index] for index in noisy]
        columns = [np.arange(place.start, place.stop) for place in places if place is not None]
        self._columns = np.concatenate([np.zeros(0, dtype=int), *columns])
        dims = [spec.dim for spec in noisy.values()]
        self._sizes = np.repeat([spec.noise for spec in noisy.values()], dims)
        bounds = [bounds_of(spec) for spec in noisy.values()]
        self._lower, self._upper = np.repeat(np.array(bounds).reshape(-1, 2), dims, axis=0).T
        keys = [(f"{body.id} {spec.name}", spec.seed, spec.dim) for spec in noisy.values()]
        self.is_any: bool = bool(keys)
        self._gaussians = Gaussians(keys or [("", 0, 0)])

    def add(self, shown: Array, source: Source) -> None:
        """Add the noise of each world to what sensors show, and keep that within bounds."""
        steps = np.rint(source.times / source.parameters.time_step).astype(np.int64)
        values = shown[:, self._columns] + self._sizes * self._gaussians.draw(source.seeds, steps)
        shown[:, self._columns] = np.minimum(np.maximum(values, self._lower), self._upper)


def together(source: Source, body: BodyCore) -> Together:
    """What reads the sensors of a body in these worlds; kept until something about them changes."""
    return _kept(source, body, _ALL)


def read_one(source: Source, body: BodyCore, index: int) -> Array:
    """What a sensor of a body shows in each world, (worlds, dim); an array of its own."""
    if body.spec.sensors[index].kind in _ALONE:
        return reading(source, body, index).copy()
    reader = _kept(source, body, index if source.reads_one else _ALL)
    place = reader.slices[index]
    return reading(source, body, index).copy() if place is None else reader.shown(source)[:, place]


def _kept(source: Source, body: BodyCore, index: int) -> Together:
    """What reads one sensor, or those of all indices; each has a table of its own."""
    kept, version = source.kept(body), source.version
    known = kept.get((Together, index))
    if known is None or known[0] is not version or known[1] is not body.spec:
        indices = range(len(body.spec.sensors)) if index == _ALL else (index,)
        known = kept[Together, index] = version, body.spec, Together(source, body, indices)
    return known[2]


def read_together(source: Source, body: BodyCore) -> list[Array]:
    """What each sensor of a body shows in each world, (worlds, dim) each."""
    return together(source, body).read(source)
