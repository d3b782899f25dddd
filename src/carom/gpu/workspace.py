"""Workspace of many worlds that are stepped in parallel on a device."""

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
from carom.layouts.contacts import Pairs
from carom.layouts.model import ENTRY_VIEWS, Scratch
from carom.layouts.newton import NewtonWork, StageWork
from carom.layouts.pair_rows import ROW_ENTRY_VIEWS, PairRows
from carom.layouts.parallel import MAX_CANDIDATES, IslandWork, PairWork, RunWork
from carom.layouts.soft import SoftWork
from carom.model.builder import WorldArrays
from carom.native.kernels import Kernel
from carom.native.launch import KernelStructs

MAX_WORKERS = 32768
"""Maximum number of threads of the narrow phase: more than a GPU runs at a time. Each needs 23 kB."""
# Initial capacity for pairs of shapes, rows over two trees and their blocks, and single contacts; doubled
# when it is too small.
_FIRST_ROOM = {"pair": 16, "row": 64, "jacobian": 256, "matrix": 64, "single": 16}
# Axes of the workspace of a single pair of shapes: each worker has one, instead of each world.
_OF_WORKERS = ("candidate", "polygon", "polytope")


@dataclass(frozen=True)
class Extent:
    """Sizes that determine the threads and arrays of a step.

    Attributes:
        worlds: Number of worlds.
        trees: Number of bodies of each world.
        shapes: Number of collision shapes of each world.
        contacts: Capacity for contacts of each world.
        pairs: Capacity for pairs of shapes of each world; 0 if no shapes can touch.
        soft_bodies: Number of soft bodies of each world.
    """

    worlds: int
    trees: int
    shapes: int
    contacts: int
    pairs: int
    soft_bodies: int

    @property
    def workers(self) -> int:
        """Number of threads of the narrow phase."""
        return max(1, min(self.worlds * self.pairs, MAX_WORKERS))


class DeviceStructs(KernelStructs):
    """Structs on a device, by the names of kernel arguments.

    Attributes:
        device: The device.
        extent: Numbers of worlds, bodies, shapes, contacts and pairs.
        arrays: The arrays of `IslandWork`, `PairWork` and `RunWork`, by the names of kernel arguments.
        parts: The present values of `RunWork.world_part`, on the host.
    """

    def __init__(self, device: Device) -> None:
        super().__init__()
        self.device = device
        self.extent = Extent(1, 0, 0, 0, 0, 0)
        self.arrays: dict[str, dict[str, Any]] = {}
        self.parts: np.ndarray = np.zeros(0, dtype=np.int32)

    def launch_over(self, module: str, kernel: str, dim: tuple[int, ...], **scalars: float) -> FineLaunch:
        """A launch of a kernel in a module of `carom.kernels`, with `dim` threads."""
        return self.device.launch(module, kernel, dim, self, {"first_world": 0, **scalars})

    def launch(self, kernel: Kernel, **scalars: float) -> Any:
        """A function that makes the launch of a kernel for `count` worlds from world `first` on."""

        def over(first: int, count: int) -> FineLaunch:
            asked = {**scalars, "first_world": first}
            return self.device.launch(MODULES[kernel.name], kernel.name, (count,), self, asked)

        return over

    def changed(self, name: str) -> None:
        """Do nothing: there are no cached launches; the engine makes new ones."""


class DeviceWorkspace(Workspace):
    """Memory for the intermediate results of all worlds, on a device."""

    def __init__(self, device: Device, world_count: int) -> None:
        self._device = device
        self._world_count = world_count
        self.scratch = DeviceTable(device, Scratch, world_count, ENTRY_VIEWS, lasts=False)
        self.pairs = DeviceTable(device, Pairs, world_count, lasts=False)
        self.pair_rows = DeviceTable(device, PairRows, world_count, ROW_ENTRY_VIEWS, lasts=False)
        self.soft_work = DeviceTable(device, SoftWork, world_count, lasts=False)
        # Empty: constraints do not converge there.
        self.newton_work = DeviceTable(device, NewtonWork, world_count, lasts=False)
        # Empty as well: there is only the usual integrator.
        self.stage_work = DeviceTable(device, StageWork, world_count, lasts=False)
        self.structs = self._on_device = DeviceStructs(device)
        self._extent: Extent | None = None

    def fit(self, arrays: WorldArrays, contact_arrays: ContactArrays) -> None:
        """Grow arrays to the capacity that the other arrays require."""
        touching = can_collide(arrays, contact_arrays)
        soft_bodies = len(contact_arrays.soft.bodies)
        if touching:
            self.pairs.reserve(_FIRST_ROOM)
        if touching or soft_bodies:
            self.pair_rows.reserve(_FIRST_ROOM)
        if touching or soft_bodies or contact_arrays.user_count > 0 or can_sleep(arrays):
            super().fit(arrays, contact_arrays)
        else:
            # Bodies cannot interact, so there are no constraint rows over two of them.
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

    def room_for_equations(self, arrays: WorldArrays, contact_arrays: ContactArrays) -> int:  # noqa: D102
        # Only where contacts yield: every world has a workspace of its own.
        impedance = contact_arrays.shapes.table.numpy["shape_impedance"]
        if not np.count_nonzero(np.asarray(impedance)[..., : contact_arrays.shapes.shape_count, 1] > 0.0):
            return 0
        return super().room_for_equations(arrays, contact_arrays)

    def room_for_detection(self, shape_count: int, contacts: int) -> dict[str, int]:  # noqa: D102
        room = super().room_for_detection(shape_count, contacts)
        return {axis: rows for axis, rows in room.items() if axis not in _OF_WORKERS}

    def bind(self, shared: Mapping[str, Any]) -> KernelStructs:  # noqa: D102
        return super().bind({**shared, "settings": self._device.numbers(shared["settings"])})

    def _make_work(self, extent: Extent) -> None:
        """Allocate the workspace of islands and pairs; the old one is freed first, without a copy."""
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
    """Shapes of the workspace of islands that are solved in parallel."""
    trees = (extent.worlds, max(1, extent.trees))
    # An island writes the terms of at most four contacts at a time.
    terms = (extent.worlds, max(1, min(4 * extent.trees, extent.contacts)))
    return {**dict.fromkeys(IslandWork.fields, trees), "terms": terms}


def _pair_work(extent: Extent) -> dict[str, tuple[int, ...]]:
    """Shapes of the workspace of the narrow phase, which handles pairs in parallel."""
    room = scratch_capacity(extent.shapes, extent.contacts)
    shapes: dict[str, tuple[int, ...]] = {
        "world_kept": (extent.worlds,),
        "pair_result": (extent.worlds, max(1, extent.pairs)),
        "candidate": (extent.worlds, max(1, MAX_CANDIDATES * extent.pairs)),
    }
    for name in PairWork.fields:
        if name.startswith("worker_"):
            shapes[name] = (extent.workers, room[name.split("_")[1]])
    return shapes
