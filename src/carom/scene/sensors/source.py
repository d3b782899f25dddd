"""Where sensors get their numbers from: a world, or many that are measured together."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from carom.checks import Array
from carom.engine.engine import Engine
from carom.engine.parameters import EngineParameters

if TYPE_CHECKING:
    from carom.engine.queries.nearest_pair import Nearest
    from carom.native.kernels import Kernel
    from carom.native.tables import ArrayTable
    from carom.scene.core.body_core import BodyCore


class Source(ABC):
    """Arrays of one world or more; the first axis of all arrays is the world.

    Attributes:
        bodies: The bodies by their numbers.
        reads_one: Whether a sensor that is read alone has a kernel and a table of its own; else all are read.
    """

    reads_one: bool = False

    def __init__(self, bodies: Mapping[int, BodyCore]) -> None:
        self.bodies: Mapping[int, BodyCore] = bodies

    @property
    @abstractmethod
    def engine(self) -> Engine:
        """The engine, with everything a step needs written to its arrays."""

    @property
    @abstractmethod
    def parameters(self) -> EngineParameters:
        """Parameters of the engine."""

    @property
    @abstractmethod
    def times(self) -> Array:
        """Simulated time of each world [s], (count,)."""

    @property
    @abstractmethod
    def seeds(self) -> np.ndarray:
        """Seed of the noise of each world, (count,) unsigned integers of 64 bits."""

    @abstractmethod
    def poses(self, body: BodyCore) -> Array:
        """World poses of inertial frames for the present coordinates; rows of links of the body are valid."""

    @abstractmethod
    def velocities(self, body: BodyCore) -> Array:
        """Their linear, then angular velocities, likewise, (count, links of all bodies, 6)."""

    @abstractmethod
    def hits(self, starts: Array, ends: Array, number: int) -> tuple[Array, np.ndarray, np.ndarray, Array]:
        """Results of n rays in each world: fractions, bodies and links, (count, n) each, and normals.

        Args:
            starts: Start points, (count, n, 3).
            ends: End points, likewise.
            number: 0 for the first link that the ray hits, 1 for the second.
        """

    @abstractmethod
    def nearest(self, first: Sequence[int], second: Sequence[int], max_distance: float) -> Nearest:
        """The nearest points of two sets of shapes, by row, up to `max_distance` [m] apart."""

    @property
    def version(self) -> object:
        """Another object after a change of the scene or of arrays."""
        raise NotImplementedError

    def kept(self, body: BodyCore) -> dict[Any, Any]:
        """What may be kept about a body, emptied when its inertial frames change."""
        raise NotImplementedError

    def reader(
        self, body: BodyCore, kernel: Kernel, table: ArrayTable, numbers: Mapping[str, int]
    ) -> Callable[[], None]:
        """A function that runs a kernel over a table of sensors in all worlds; valid for this `version`."""
        raise NotImplementedError

    def loads(self, body: BodyCore) -> Array:
        """`State.link_load` of the last step; rows of links of the body are valid."""
        return self.state("link_load")

    @property
    def count(self) -> int:
        """Number of worlds."""
        return self.engine.arrays.world_count

    def state(self, name: str) -> Array:
        """A field of `State`, on the host."""
        return np.asarray(self.engine.arrays.state.numpy[name])

    def contacts(self, name: str) -> np.ndarray:
        """A field of `Contacts`, on the host."""
        return np.asarray(self.engine.contact_arrays.contacts.numpy[name])

    def parameter(self, name: str, row: int) -> Array:
        """A row of a field of `Model` in each world, (count, ...)."""
        values = np.asarray(self.engine.arrays.model.numpy[name])[:, row]
        return np.broadcast_to(values, (self.count, *values.shape[1:]))

    def topology(self, name: str) -> np.ndarray:
        """A field of `Model` that all worlds share."""
        return np.asarray(self.engine.arrays.model.numpy[name])
