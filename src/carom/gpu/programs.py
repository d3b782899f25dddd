"""A step of any number of worlds as a sequence of fine launches, for CUDA devices.

Nothing is copied to the host between the launches, so CUDA devices can capture the sequence as a graph.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Any

from carom.engine.program import Plan, Program
from carom.gpu.device import FineLaunch
from carom.gpu.workspace import DeviceStructs
from carom.native.launch import KernelStructs


def parallel_step_program(structs: KernelStructs, plan: Plan) -> Program:
    """The launches of a step of all worlds that take part in it.

    If a world has an error, or its arrays are too small, the end of the step restores its state from before.
    """
    if plan.adhesive:
        raise NotImplementedError(
            "actuators that pull a link towards what touches it (Adhesion, <adhesion>) are not built for "
            "devices; leave device out, or remove them"
        )
    launches = _Launches(structs)
    if not plan.coupled:
        return launches.uncoupled(plan)
    return _program(
        begin=launches.begin(plan),
        detection=launches.detection() if plan.touching else (),
        motion=launches.motion(plan),
        end=launches.end(plan),
    )


def parallel_detection_program(structs: KernelStructs) -> Program:
    """The launches that find all contacts for the present coordinates."""
    launches = _Launches(structs)
    return _program(begin=launches.begin(), detection=launches.detection(), end=launches.end())


def _program(
    begin: Iterable[FineLaunch],
    end: Iterable[FineLaunch],
    detection: Iterable[FineLaunch] = (),
    motion: Iterable[FineLaunch] = (),
) -> Program:
    """A program of launches on a device, for the steppers of `carom.gpu.stepper` only."""
    parts: list[Any] = [list(begin), list(detection), list(motion), list(end)]
    return Program(*parts, abandon=[])


class _Launches:
    """The launches of the parts of a step."""

    def __init__(self, structs: Any) -> None:
        self._structs: DeviceStructs = structs
        extent = self._structs.extent
        self._workers = (extent.workers,)
        self._worlds = (extent.worlds,)
        self._trees = (extent.trees, extent.worlds)
        self._shapes = (extent.shapes, extent.worlds)
        self._soft_bodies = (extent.soft_bodies, extent.worlds)

    def _launch(self, module: str, kernel: str, dim: tuple[int, ...], **scalars: int) -> Any:
        return self._structs.launch_over(module, kernel, dim, **scalars)

    def begin(self, plan: Plan | None = None) -> Iterator[FineLaunch]:
        """The beginning of a step, or without a plan that of collision detection."""
        yield self._launch("parallel.trees", "begin_kernel", self._trees, moves=int(plan is not None))
        if plan is not None and plan.soft:
            yield self._launch("parallel.soft_nodes", "soft_begin_kernel", self._soft_bodies)
        if plan is not None and plan.late:
            yield self._launch("parallel.late_trees", "late_begin_kernel", self._trees)

    def end(self, plan: Plan | None = None) -> Iterator[FineLaunch]:
        """The end of a step, or without a plan that of collision detection."""
        yield self._launch("parallel.trees", "end_kernel", self._trees, moves=int(plan is not None))
        if plan is not None and plan.soft:
            yield self._launch("parallel.soft_nodes", "soft_end_kernel", self._soft_bodies)
        if plan is not None and plan.late:
            yield self._launch("parallel.late_trees", "late_end_kernel", self._trees)
        yield self._launch("parallel.runs", "finish_kernel", self._worlds)

    def uncoupled(self, plan: Plan) -> Program:
        """A step of worlds whose bodies do not interact: one launch performs all substeps."""
        batches = self._launch("parallel.batches", "batch_step_kernel", self._trees, substeps=1)
        faults = self._launch("parallel.trees", "faults_kernel", self._worlds)
        return _program(begin=[batches, faults], end=self.end(plan))

    def detection(self) -> Iterator[FineLaunch]:
        yield self._launch("parallel.trees", "tree_poses_kernel", self._trees)
        yield self._launch("parallel.detection", "shape_bounds_kernel", self._shapes)
        yield self._launch("parallel.detection", "world_pairs_kernel", self._worlds)
        yield self._launch("parallel.detection", "pair_candidates_kernel", self._workers)
        yield self._launch("parallel.detection", "world_contacts_kernel", self._worlds)

    def motion(self, plan: Plan) -> Iterator[FineLaunch]:
        if plan.sleeping:
            yield self._launch("solver.sleeping", "settle_kernel", self._worlds, touching=int(plan.touching))
        if plan.soft:
            yield self._launch("parallel.soft_nodes", "tree_velocities_kernel", self._trees)
        yield self._launch("parallel.trees", "world_islands_kernel", self._worlds)
        yield self._tree_motion("tree_free_motion_kernel", plan)
        if plan.soft:
            yield from self._soft_motion()
        yield from self._solver()
        yield self._tree_motion("tree_motion_kernel", plan)
        yield self._launch("parallel.trees", "faults_kernel", self._worlds)
        if plan.soft:
            # After the motion of trees, which also moves fixed bases by their velocities.
            yield self._launch("parallel.soft_nodes", "soft_poses_kernel", self._soft_bodies)
        if plan.sleeping:
            yield self._launch("solver.sleeping", "watch_kernel", self._worlds)

    def _tree_motion(self, kernel: str, plan: Plan) -> FineLaunch:
        """A launch over all trees, or what takes its place where links have late velocities."""
        if plan.late:
            return self._launch("parallel.late_trees", f"late_{kernel}", self._trees)
        return self._launch("parallel.trees", kernel, self._trees)

    def _soft_motion(self) -> Iterator[FineLaunch]:
        yield self._launch("parallel.soft_contact", "soft_start_kernel", self._worlds)
        yield self._launch("parallel.soft_contact", "soft_touches_kernel", self._soft_bodies)
        yield self._launch("parallel.soft_contact", "soft_rows_kernel", self._worlds)
        yield self._launch("parallel.soft_contact", "soft_neighbours_kernel", self._worlds)
        yield self._launch("parallel.soft_motion", "small_steps_kernel", self._worlds)
        yield self._launch("parallel.soft_motion", "soft_pushes_kernel", self._worlds)

    def _solver(self) -> Iterator[FineLaunch]:
        yield self._launch("parallel.joint_rows", "island_rows_kernel", self._trees)
        yield self._launch("parallel.contact_rows", "island_contacts_kernel", self._trees)
        yield self._launch("parallel.sweeps", "resting_sweeps_kernel", self._trees)
        # Again for islands at rest that did not converge: their contacts are rewritten with zero impulses.
        yield self._launch("parallel.contact_rows", "island_contacts_kernel", self._trees)
        yield self._launch("parallel.restless_sweeps", "restless_sweeps_kernel", self._trees)
        yield self._launch("parallel.joint_rows", "island_impulses_kernel", self._trees)
