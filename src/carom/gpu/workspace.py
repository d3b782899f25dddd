"""Intermediate results of many worlds that are stepped side by side."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from carom.engine.can_collide import can_collide, can_sleep
from carom.engine.contact_arrays import ContactArrays
from carom.engine.detection_capacity import scratch_capacity
from carom.engine.workspace import Workspace
from carom.gpu.device import MODULES, Device, FineLaunch
from carom.gpu.tables import DeviceTable, struct_of_zeros
from carom.layouts.contacts import ROW_ENTRY_VIEWS, PairRows, Pairs
from carom.layouts.model import ENTRY_VIEWS, Scratch
from carom.layouts.parallel import MOST_CANDIDATES, IslandWork, PairWork, RunWork
from carom.layouts.soft import SoftWork
from carom.model.builder import WorldArrays
from carom.native.kernels import Kernel
from carom.native.launch import KernelStructs

MOST_WORKERS = 32768
"""Threads that look for contacts: more than a GPU runs at a time. Each needs 23 kB."""
# Room for pairs of shapes, rows over two trees and their blocks to begin with; it doubles where it is short.
_FIRST_ROOM = {"pair": 16, "row": 64, "jacobian": 256, "matrix": 64}
# Memory for the search in one pair, which belongs to workers, not to worlds.
_OF_WORKERS = ("candidate", "polygon", "polytope")


@dataclass(frozen=True)
class Extent:
    """Sizes of a step.

    Attributes:
        worlds: Worlds.
        trees: Bodies of each.
        shapes: Collision shapes of each.
        contacts: Contacts of each that there is room for.
        pairs: Pairs of shapes of each that there is room for; 0 if nothing can touch.
        soft_bodies: Soft bodies of each.
    """

    worlds: int
    trees: int
    shapes: int
    contacts: int
    pairs: int
    soft_bodies: int

    @property
    def workers(self) -> int:
        """Threads that look for contacts."""
        return max(1, min(self.worlds * self.pairs, MOST_WORKERS))


class DeviceStructs(KernelStructs):
    """Structs by the names kernels give them, on a device.

    Attributes:
        device: The device.
        extent: The numbers of links, joints and so on.
        arrays: The arrays of `IslandWork`, `PairWork` and `RunWork`, by the names of these structs.
        parts: What `RunWork.world_part` has been set to.
    """

    def __init__(self, device: Device) -> None:
        super().__init__()
        self.device = device
        self.extent = Extent(1, 0, 0, 0, 0, 0)
        self.arrays: dict[str, dict[str, Any]] = {}
        self.parts: np.ndarray = np.zeros(0, dtype=np.int32)

    def launch_over(self, module: str, kernel: str, dim: tuple[int, ...], **scalars: float) -> FineLaunch:
        """A launch of a kernel in a module of `carom.kernels`, as many times as `dim` says."""
        return self.device.launch(module, kernel, dim, self, {"first_world": 0, **scalars})

    def launch(self, kernel: Kernel, **scalars: float) -> Any:
        """A launch of a kernel for some of the worlds, by the first of them and their number."""

        def over(first: int, count: int) -> FineLaunch:
            asked = {**scalars, "first_world": first}
            return self.device.launch(MODULES[kernel.name], kernel.name, (count,), self, asked)

        return over

    def changed(self, name: str) -> None:
        """Launches have to be made again; their engine sees to that."""


class DeviceWorkspace(Workspace):
    """Room for the intermediate results of all worlds, on a device.

    Args:
        device: The device.
        world_count: Number of worlds.
    """

    def __init__(self, device: Device, world_count: int) -> None:
        self._device = device
        self._world_count = world_count
        self.scratch = DeviceTable(device, Scratch, world_count, ENTRY_VIEWS, lasts=False)
        self.pairs = DeviceTable(device, Pairs, world_count, lasts=False)
        self.pair_rows = DeviceTable(device, PairRows, world_count, ROW_ENTRY_VIEWS, lasts=False)
        self.soft_work = DeviceTable(device, SoftWork, world_count, lasts=False)
        self.structs = self._on_device = DeviceStructs(device)
        self._extent: Extent | None = None

    def fit(self, arrays: WorldArrays, contact_arrays: ContactArrays) -> None:
        """Resize arrays to the length of the arrays they belong to."""
        touching = can_collide(arrays, contact_arrays)
        soft_bodies = len(contact_arrays.soft.bodies)
        if touching:
            self.pairs.reserve(_FIRST_ROOM)
        if touching or soft_bodies:
            self.pair_rows.reserve(_FIRST_ROOM)
        if touching or soft_bodies or contact_arrays.user_count > 0 or can_sleep(arrays):
            super().fit(arrays, contact_arrays)
        else:
            # Nothing ties bodies together, and there are no rows over two of them.
            self.scratch.reserve(arrays.used)
            self.pairs.reserve(self.room_for_detection(contact_arrays.shapes.shape_count, 0))
        extent = Extent(
            self._world_count,
            arrays.used["tree"],
            contact_arrays.shapes.shape_count,
            contact_arrays.contacts.capacity["contact"],
            self.pairs.capacity["pair"] if touching else 0,
            soft_bodies,
        )
        if extent != self._extent:
            self._make_work(extent)
            self._extent = self._on_device.extent = extent

    def room_for_detection(self, shape_count: int, contacts: int) -> dict[str, int]:  # noqa: D102
        room = super().room_for_detection(shape_count, contacts)
        return {axis: rows for axis, rows in room.items() if axis not in _OF_WORKERS}

    def bind(self, shared: Mapping[str, Any]) -> KernelStructs:  # noqa: D102
        return super().bind({**shared, "settings": self._device.numbers(shared["settings"])})

    def _make_work(self, extent: Extent) -> None:
        """Make room for islands and pairs. That is not kept, and goes before there is other."""
        before = self._on_device.arrays.get("run")
        self._on_device.arrays.clear()
        shapes = {"work": _island_work(extent), "pair_work": _pair_work(extent)}
        for name, declared in (("work", IslandWork), ("pair_work", PairWork)):
            self.structs.pop(name, None)
            self._on_device.arrays[name] = struct_of_zeros(self._device, declared, shapes[name])
        run = {"world_part": (extent.worlds,), "trouble": (1,)}
        self._on_device.arrays["run"] = before or struct_of_zeros(self._device, RunWork, run)
        for name, declared in (("work", IslandWork), ("pair_work", PairWork), ("run", RunWork)):
            self.structs[name] = self._device.struct(declared, self._on_device.arrays[name])


def _island_work(extent: Extent) -> dict[str, tuple[int, ...]]:
    """Shapes of the workspace of islands that are solved side by side."""
    trees = (extent.worlds, max(1, extent.trees))
    # An island writes the terms of at most four contacts at a time.
    terms = (extent.worlds, max(1, min(4 * extent.trees, extent.contacts)))
    return {**dict.fromkeys(IslandWork.fields, trees), "terms": terms}


def _pair_work(extent: Extent) -> dict[str, tuple[int, ...]]:
    """Shapes of the room for looking for contacts in pairs side by side."""
    room = scratch_capacity(extent.shapes, extent.contacts)
    room["candidates"] = room["candidate"]
    shapes: dict[str, tuple[int, ...]] = {
        "world_kept": (extent.worlds,),
        "pair_found": (extent.worlds, max(1, extent.pairs)),
        "candidate_terms": (extent.worlds, max(1, MOST_CANDIDATES * extent.pairs)),
    }
    for name in PairWork.fields:
        if name.startswith("worker_"):
            shapes[name] = (extent.workers, room[name.split("_")[1]])
    return shapes
