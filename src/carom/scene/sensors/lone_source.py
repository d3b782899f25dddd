"""Numbers for sensors from a single world."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from carom.checks import Array
from carom.engine.engine import Engine
from carom.engine.parameters import EngineParameters
from carom.native.launch import Launch
from carom.scene.sensors.source import Source

if TYPE_CHECKING:
    from carom.engine.queries.nearest_pair import Nearest
    from carom.native.kernels import Kernel
    from carom.native.tables import ArrayTable
    from carom.scene.core.body_core import BodyCore
    from carom.scene.core.world_core import WorldCore


class LoneSource(Source):
    """A world as a source for sensors.

    Args:
        world: The world.
        within_change: Used within a change of the world's bodies; only coordinates and poses are valid then.
    """

    reads_one: bool = True

    def __init__(self, world: WorldCore, *, within_change: bool = False) -> None:
        # Not by way of `Source`: one is made for each reading.
        self.bodies = world.bodies
        self._world = world
        if not within_change:
            world.prepare()

    @property
    def engine(self) -> Engine:
        """See `Source`."""
        return self._world.engine

    @property
    def parameters(self) -> EngineParameters:
        """See `Source`."""
        return self._world.parameters

    @property
    def times(self) -> Array:
        """See `Source`."""
        return np.array([self._world.time])

    @property
    def seeds(self) -> np.ndarray:
        """See `Source`."""
        return np.array([self._world.parameters.sensor_seed], dtype=np.int64).view(np.uint64)

    def poses(self, body: BodyCore) -> Array:
        """See `Source`."""
        self._world.update_link_poses(body)
        return self.state("link_pose")

    def velocities(self, body: BodyCore) -> Array:
        """See `Source`."""
        self._world.update_link_poses(body)
        self._world.update_link_velocities(body)
        return self.state("link_twist")

    @property
    def version(self) -> object:
        """See `Source`."""
        return self._world.scene_version

    def kept(self, body: BodyCore) -> dict[Any, Any]:
        """See `Source`."""
        return body.derived

    def reader(
        self, body: BodyCore, kernel: Kernel, table: ArrayTable, numbers: Mapping[str, int]
    ) -> Callable[[], None]:
        """See `Source`."""
        given = {**self.engine.structs(), "sensors": table.struct(), **numbers, "first_world": 0}
        return Launch(kernel, 1, [given[name] for name in kernel.indices]).brief_function

    def loads(self, body: BodyCore) -> Array:
        """See `Source`."""
        self._world.settle_loads(body)
        return self.state("link_load")

    def hits(self, starts: Array, ends: Array, number: int) -> tuple[Array, np.ndarray, np.ndarray, Array]:
        """See `Source`."""
        # A link that was hit is not hit again along the whole ray.
        first, last = starts.reshape(-1, 3), ends.reshape(-1, 3)
        found = self._world.queries().cast_rays(first, last, hit_number=number, separation=1.0)
        bodies, links, fractions, _, normals = (
            np.array(part).reshape(*starts.shape[:2], -1) for part in zip(*found, strict=True)
        )
        return fractions[..., 0], bodies[..., 0], links[..., 0], normals

    def nearest(self, first: Sequence[int], second: Sequence[int], max_distance: float) -> Nearest:
        """See `Source`."""
        return self._world.queries().nearest_shapes(first, second, max_distance)
