"""Many worlds as a source of what sensors measure."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from carom.checks import Array
from carom.engine.engine import Engine
from carom.engine.parameters import EngineParameters
from carom.engine.queries.nearest_pair import Nearest, NearestFinder
from carom.engine.task import Task
from carom.engine.threads import WORLDS_PER_THREAD
from carom.layouts.magnitudes import MAX_DISTANCE
from carom.native.kernels import Kernel, settle_loads_kernel
from carom.native.launch import KernelStructs, Launch
from carom.native.tables import ArrayTable
from carom.scene.core.body_core import BodyCore
from carom.scene.sensors.reading import StepWatch, forget, remembered
from carom.scene.sensors.source import Source
from carom.world.world import World
from carom.worlds.poses import PoseFinder
from carom.worlds.rays import RayCaster


class BatchSource(Source):
    """Many worlds as a source for sensors; `times` are those of `Worlds`."""

    def __init__(self, scene: World, engine: Engine, times: Array) -> None:
        super().__init__(scene.bodies)
        self._scene = scene
        self._engine = engine
        self._times = times
        first = scene.parameters.sensor_seed
        self.own_seeds: NDArray[np.int64] = np.arange(
            first, first + engine.arrays.world_count, dtype=np.int64
        )
        self._finders: dict[int, PoseFinder] = {}
        self._casters: dict[tuple[int, int], RayCaster] = {}
        self._settlers: dict[int, Task] = {}
        self.remembered: list[tuple[BodyCore, int]] = remembered(list(scene.bodies.values()))

    @property
    def engine(self) -> Engine:
        """See `Source`."""
        return self._engine

    @property
    def parameters(self) -> EngineParameters:
        """See `Source`."""
        return self._scene.parameters

    @property
    def times(self) -> Array:
        """See `Source`."""
        return self._times

    @property
    def seeds(self) -> np.ndarray:
        """See `Source`."""
        return self.own_seeds.view(np.uint64)

    def poses(self, body: BodyCore) -> Array:
        """See `Source`."""
        return np.asarray(self._finder(body).poses())

    def velocities(self, body: BodyCore) -> Array:
        """See `Source`."""
        return np.asarray(self._finder(body).velocities())

    def hits(self, starts: Array, ends: Array, number: int) -> tuple[Array, np.ndarray, np.ndarray, Array]:
        """See `Source`."""
        # A caster is made for a count of rays.
        key = number, starts.shape[1]
        if key not in self._casters:
            # A link that was hit is not hit again along the whole ray.
            places = self._scene.link_places
            self._casters[key] = RayCaster(self._engine, places, hit_number=number, separation=1.0)
        found = self._casters[key](starts, ends, -1)
        bodies, links = np.asarray(found.bodies), np.asarray(found.links)
        return np.asarray(found.fractions), bodies, links, np.asarray(found.normals)

    @cached_property
    def _nearest(self) -> NearestFinder:
        return NearestFinder(self._engine)

    def nearest(self, first: Sequence[int], second: Sequence[int], max_distance: float) -> Nearest:
        """See `Source`."""
        return self._nearest(first, second, min(max_distance, MAX_DISTANCE))

    @property
    def version(self) -> object:
        """See `Source`."""
        return self._scene

    def kept(self, body: BodyCore) -> dict[Any, Any]:
        """See `Source`."""
        return body.derived.setdefault(self, {})

    def reader(
        self, body: BodyCore, kernel: Kernel, table: ArrayTable, numbers: Mapping[str, int]
    ) -> Callable[[], None]:
        """See `Source`."""

        def launches(structs: KernelStructs) -> list[Launch]:
            structs.update(sensors=table.struct())
            return [structs.launch(kernel, first_world=0, **numbers)]

        return self._engine.task(launches, WORLDS_PER_THREAD)

    def loads(self, body: BodyCore) -> Array:
        """See `Source`."""
        if body.id not in self._settlers:
            self._settlers[body.id] = self._engine.task(
                lambda structs: [structs.launch(settle_loads_kernel, tree=body.rows.tree, first_world=0)],
                WORLDS_PER_THREAD,
            )
        self._settlers[body.id]()
        return self.state("link_load")

    def watch(self) -> StepWatch | None:
        """Begin to measure in a step, if some sensor has a memory."""
        return StepWatch(self, self.remembered) if self.remembered else None

    def forget(self, body: BodyCore, worlds: np.ndarray) -> None:
        """Empty the memories of a body's sensors in some worlds."""
        forget(self, body, worlds)

    def _finder(self, body: BodyCore) -> PoseFinder:
        if body.id not in self._finders:
            self._finders[body.id] = PoseFinder(self._engine, body.rows.tree)
        return self._finders[body.id]
