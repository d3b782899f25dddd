"""A step of any number of worlds as a sequence of fine launches, for CUDA devices.

Nothing is read back between them, so on a CUDA device the whole sequence can be captured as a graph.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

import warp as wp

from carom.collision.capacity import scratch_capacity
from carom.collision.pair_work import MOST_CANDIDATES, PairWork
from carom.collision.parallel import (
    pair_candidates_kernel,
    place_shapes_kernel,
    world_contacts_kernel,
    world_pairs_kernel,
)
from carom.engine.program import Plan
from carom.model.contact_structs import ContactTerms
from carom.model.launch import argument_indices
from carom.model.real import Index4, Vector3, Vector4, Vector8
from carom.physics.parallel import BLOCK_SIZE
from carom.physics.parallel.batches import batch_step_kernel
from carom.physics.parallel.contact_rows import island_contacts_kernel
from carom.physics.parallel.joint_rows import island_impulses_kernel, island_rows_kernel
from carom.physics.parallel.restless_sweeps import restless_sweeps_kernel
from carom.physics.parallel.sweeps import calm_sweeps_kernel
from carom.physics.parallel.trees import (
    begin_kernel,
    end_kernel,
    faults_kernel,
    restore_kernel,
    tree_free_motion_kernel,
    tree_motion_kernel,
    tree_poses_kernel,
    world_islands_kernel,
)
from carom.physics.parallel.workspace import IslandProgress, IslandWork, Window
from carom.physics.slumber import settle_kernel, watch_kernel

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


def island_work(extent: Extent, device: str) -> Any:
    """The workspace of islands that are solved side by side."""

    def rows(count: int, dtype: Any) -> Any:
        return wp.zeros((extent.worlds, max(1, count)), dtype=dtype, device=device)

    work = IslandWork()
    work.tree_window = rows(extent.trees, Window)
    work.tree_room = rows(extent.trees, Window)
    work.tree_progress = rows(extent.trees, IslandProgress)
    work.tree_free_fault = rows(extent.trees, wp.int32)
    work.tree_motion_fault = rows(extent.trees, wp.int32)
    # An island writes those of at most four contacts at a time.
    work.terms = rows(min(4 * extent.trees, extent.contacts), ContactTerms)
    return work


def pair_work(extent: Extent, device: str) -> Any:
    """Room for looking for contacts in pairs side by side."""
    workers = max(1, min(extent.worlds * extent.pairs, MOST_WORKERS))
    room = scratch_capacity(extent.shapes, extent.contacts)

    def rows(count: int, length: int, dtype: Any) -> Any:
        return wp.zeros((count, length), dtype=dtype, device=device)

    work = PairWork()
    work.world_kept = wp.zeros(extent.worlds, dtype=wp.int32, device=device)
    work.pair_found = rows(extent.worlds, extent.pairs, Index4)
    work.candidate_terms = rows(extent.worlds, MOST_CANDIDATES * extent.pairs, Vector8)
    work.worker_candidates = rows(workers, room["candidate"], Vector8)
    for name in ("polygon_a", "polygon_b", "polygon_clipped"):
        setattr(work, f"worker_{name}", rows(workers, room["polygon"], Vector3))
    for name, dtype in (
        ("point", Vector3),
        ("point_a", Vector3),
        ("plane", Vector4),
        ("face", Index4),
        ("edge", Index4),
    ):
        setattr(work, f"worker_polytope_{name}", rows(workers, room["polytope"], dtype))
    return work


class ParallelStep:
    """The launches of a step of many worlds.

    Args:
        structs: Warp structs over arrays on the device, by the names kernels give them: `settings`, `model`,
            `state`, `shapes`, `contacts`, `users`, and the workspace of every world: `scratch`, `pairs`,
            `couplings`.
        extent: How many of everything there are.
        substeps: Substeps of a step, at least 1.
        device: Warp device name.
        plan: What steps have to look for.
    """

    def __init__(
        self,
        structs: Mapping[str, Any],
        extent: Extent,
        substeps: int,
        device: str,
        plan: Plan,
    ) -> None:
        self._structs = {**structs, "work": island_work(extent, device)}
        if plan.touching:
            self._structs["pair_work"] = pair_work(extent, device)
        self._workers = max(1, min(extent.worlds * extent.pairs, MOST_WORKERS))
        self._device = device
        self._worlds = extent.worlds
        self._trees = (extent.trees, extent.worlds)
        self._shapes = (extent.shapes, extent.worlds)
        stages = self._coupled(substeps, plan) if plan.coupled else self._uncoupled(substeps)
        self._launches = list(stages)
        self._graph: Any = None

    def __call__(self) -> None:
        """Perform a step of every world; on a CUDA device this returns before it is done."""
        if self._graph is not None:
            wp.capture_launch(self._graph)
            return
        for launch in self._launches:
            launch.launch()

    def capture(self) -> None:
        """Make one CUDA graph of all launches, for later steps."""
        with wp.ScopedCapture(device=self._device) as capture:
            self()
        self._graph = capture.graph

    def _launch(self, kernel: Any, dim: int | tuple[int, int], **scalars: int) -> Any:
        names = argument_indices(kernel)
        scalars = {"first_world": 0, **scalars}
        arguments = [scalars[name] if name in scalars else self._structs[name] for name in names]
        return wp.launch(
            kernel,
            dim=dim,
            inputs=arguments,
            device=self._device,
            record_cmd=True,
            block_dim=1 if wp.get_device(self._device).is_cpu else BLOCK_SIZE,
        )

    def _uncoupled(self, substeps: int) -> Iterator[Any]:
        yield self._launch(batch_step_kernel, self._trees, substeps=substeps)
        yield self._launch(faults_kernel, self._worlds)
        yield self._launch(end_kernel, self._trees)

    def _coupled(self, substeps: int, plan: Plan) -> Iterator[Any]:
        yield self._launch(begin_kernel, self._trees)
        for _substep in range(substeps):
            yield from self._detection(plan)
            if plan.sleeping:
                yield self._launch(settle_kernel, self._worlds, touching=int(plan.touching))
            yield self._launch(world_islands_kernel, self._worlds)
            yield self._launch(tree_free_motion_kernel, self._trees)
            yield from self._solver()
            yield self._launch(tree_motion_kernel, self._trees)
            yield self._launch(faults_kernel, self._worlds)
            if plan.sleeping:
                yield self._launch(watch_kernel, self._worlds)
        yield self._launch(end_kernel, self._trees)
        yield self._launch(restore_kernel, self._worlds)

    def _detection(self, plan: Plan) -> Iterator[Any]:
        if plan.touching:
            yield self._launch(tree_poses_kernel, self._trees)
            yield self._launch(place_shapes_kernel, self._shapes)
            yield self._launch(world_pairs_kernel, self._worlds)
            yield self._launch(pair_candidates_kernel, self._workers)
            yield self._launch(world_contacts_kernel, self._worlds)

    def _solver(self) -> Iterator[Any]:
        yield self._launch(island_rows_kernel, self._trees)
        yield self._launch(island_contacts_kernel, self._trees)
        yield self._launch(calm_sweeps_kernel, self._trees)
        # Those of islands that are calm but could not be solved so are written once more.
        yield self._launch(island_contacts_kernel, self._trees)
        yield self._launch(restless_sweeps_kernel, self._trees)
        yield self._launch(island_impulses_kernel, self._trees)
