"""A step of any number of worlds as a sequence of fine launches, for CUDA devices.

Nothing is read back between them, so on a CUDA device the whole sequence can be captured as a graph.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from carom.engine.detection_capacity import scratch_capacity
from carom.engine.program import Plan
from carom.gpu.device import Device
from carom.layouts.parallel import MOST_CANDIDATES, IslandWork, PairWork

# Threads that look for contacts: more than a GPU runs at a time. Each needs 23 kB.
MOST_WORKERS = 32768


@dataclass(frozen=True)
class Extent:
    """How many of everything there are in a step.

    Attributes:
        worlds: Worlds.
        trees: Bodies of each.
        shapes: Collision shapes of each.
        contacts: Contacts of each that there is room for.
        pairs: Pairs of shapes of each that there is room for.
    """

    worlds: int
    trees: int
    shapes: int
    contacts: int
    pairs: int


def island_work(extent: Extent, device: Device) -> Any:
    """The workspace of islands that are solved side by side."""
    trees = (extent.worlds, max(1, extent.trees))
    # An island writes the terms of at most four contacts at a time.
    terms = (extent.worlds, max(1, min(4 * extent.trees, extent.contacts)))
    return device.zeros(IslandWork, {**dict.fromkeys(IslandWork.fields, trees), "terms": terms})


def pair_work(extent: Extent, device: Device) -> Any:
    """Room for looking for contacts in pairs side by side."""
    workers = workers_for(extent)
    room = scratch_capacity(extent.shapes, extent.contacts)
    room["candidates"] = room["candidate"]
    shapes: dict[str, tuple[int, ...]] = {
        "world_kept": (extent.worlds,),
        "pair_found": (extent.worlds, max(1, extent.pairs)),
        "candidate_terms": (extent.worlds, max(1, MOST_CANDIDATES * extent.pairs)),
    }
    for name in PairWork.fields:
        if name.startswith("worker_"):
            shapes[name] = (workers, room[name.split("_")[1]])
    return device.zeros(PairWork, shapes)


def workers_for(extent: Extent) -> int:
    """Threads that look for contacts."""
    return max(1, min(extent.worlds * extent.pairs, MOST_WORKERS))


class ParallelStep:
    """The launches of a step of many worlds.

    Args:
        structs: Structs over arrays on the device, by the names kernels give them: `settings`, `model`,
            `state`, `shapes`, `contacts`, `users`, and the workspace of every world: `scratch`, `pairs`,
            `pair_rows`.
        extent: How many of everything there are.
        substeps: Substeps of a step, at least 1.
        device: Where they run.
        plan: What steps have to look for.
    """

    def __init__(
        self, structs: Mapping[str, Any], extent: Extent, substeps: int, device: Device, plan: Plan
    ) -> None:
        self._structs = {**structs, "work": island_work(extent, device)}
        if plan.touching:
            self._structs["pair_work"] = pair_work(extent, device)
        self._workers = (workers_for(extent),)
        self._device = device
        self._worlds = (extent.worlds,)
        self._trees = (extent.trees, extent.worlds)
        self._shapes = (extent.shapes, extent.worlds)
        stages = self._coupled(substeps, plan) if plan.coupled else self._uncoupled(substeps)
        self._launches = list(stages)

    def __call__(self) -> None:
        """Perform a step of every world; on a CUDA device this returns before it is done."""
        for launch in self._launches:
            launch()

    def _launch(self, module: str, kernel: str, dim: tuple[int, ...], **scalars: int) -> Callable[[], None]:
        return self._device.launch(module, kernel, dim, self._structs, {"first_world": 0, **scalars})

    def _uncoupled(self, substeps: int) -> Iterator[Callable[[], None]]:
        yield self._launch("parallel.batches", "batch_step_kernel", self._trees, substeps=substeps)
        yield self._launch("parallel.trees", "faults_kernel", self._worlds)
        yield self._launch("parallel.trees", "end_kernel", self._trees)

    def _coupled(self, substeps: int, plan: Plan) -> Iterator[Callable[[], None]]:
        yield self._launch("parallel.trees", "begin_kernel", self._trees)
        for _substep in range(substeps):
            yield from self._detection(plan)
            if plan.sleeping:
                yield self._launch("solver.sleep", "settle_kernel", self._worlds, touching=int(plan.touching))
            yield self._launch("parallel.trees", "world_islands_kernel", self._worlds)
            yield self._launch("parallel.trees", "tree_free_motion_kernel", self._trees)
            yield from self._solver()
            yield self._launch("parallel.trees", "tree_motion_kernel", self._trees)
            yield self._launch("parallel.trees", "faults_kernel", self._worlds)
            if plan.sleeping:
                yield self._launch("solver.sleep", "watch_kernel", self._worlds)
        yield self._launch("parallel.trees", "end_kernel", self._trees)
        yield self._launch("parallel.trees", "restore_kernel", self._worlds)

    def _detection(self, plan: Plan) -> Iterator[Callable[[], None]]:
        if plan.touching:
            yield self._launch("parallel.trees", "tree_poses_kernel", self._trees)
            yield self._launch("parallel.detection", "shape_bounds_kernel", self._shapes)
            yield self._launch("parallel.detection", "world_pairs_kernel", self._worlds)
            yield self._launch("parallel.detection", "pair_candidates_kernel", self._workers)
            yield self._launch("parallel.detection", "world_contacts_kernel", self._worlds)

    def _solver(self) -> Iterator[Callable[[], None]]:
        yield self._launch("parallel.joint_rows", "island_rows_kernel", self._trees)
        yield self._launch("parallel.contact_rows", "island_contacts_kernel", self._trees)
        yield self._launch("parallel.sweeps", "resting_sweeps_kernel", self._trees)
        # Those of islands at rest that could not be solved so are written once more.
        yield self._launch("parallel.contact_rows", "island_contacts_kernel", self._trees)
        yield self._launch("parallel.restless_sweeps", "restless_sweeps_kernel", self._trees)
        yield self._launch("parallel.joint_rows", "island_impulses_kernel", self._trees)
