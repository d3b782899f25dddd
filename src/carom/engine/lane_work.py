"""What steps of several worlds at once need.

Each lane has a workspace, in which a world takes its step (`native/source/perform.cpp`).
`lane_motion_kernel` sees numbers of several worlds side by side, so it has arrays of its own: those that it
reads are gathered from the worlds before each step, and what it finds out is handed to the steps of single
worlds (`native/source/lanes/lane_motion.cpp`).
"""

from __future__ import annotations

import ctypes
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any

import numpy as np

from carom.engine.lane_arrays import NUMBER, Wide, rows_of_lanes, rows_of_worlds, struct_of, widened
from carom.engine.lane_sweeps import LaneSweepWork
from carom.engine.parameters import OF_STEPS
from carom.engine.program import Plan, lane_program, world_call, write_program
from carom.engine.workspace import Workspace
from carom.layouts.model import Model, Scratch, State
from carom.layouts.programs import (
    LANES,
    WAITING_ROOT,
    WAITING_SWEEPS,
    KernelCall,
    LaneMotion,
    LaneRows,
    LaneWorld,
)
from carom.model.builder import WorldArrays
from carom.native.arrays import c_array, zeros
from carom.native.kernels import lane_impulses_kernel, lane_motion_kernel
from carom.native.launch import KernelStructs, Launch
from carom.native.tables import array_view, fields_of

# Fields that are gathered, by the argument of the kernel.
_READ = {
    "model": (
        *("gravity_vector", "fluid_density", "fluid_viscosity", "fluid_wind"),
        *("tree_linear_damping", "tree_angular_damping", "tree_joint_terms"),
        *("link_mass", "link_inertia", "link_gravity_compensation"),
        *("link_fluid_shape", "link_fluid_added"),
        *("dof_damping", "dof_armature", "dof_implicit_damping", "dof_stiffness", "position_spring"),
    ),
    "state": ("position", "dof_velocity", "dof_torque", "dof_pd", "link_wrench"),
}
_AXES = {
    name: {field: known.axis for field, known in fields_of(struct).items()}
    for name, struct in (("model", Model), ("state", State), ("scratch", Scratch))
}
# Axes with one entry.
_OF_WORLD = ("gravity", "fluid")
# Others that the kernel writes.
_WRITTEN = {"state": ("link_pose",), "scratch": ("link", "dof", "block_factor", "block_inverse_mass")}
# And where rows converge, or damping counts at the end of a substep.
_KEPT = "mass_block"
_LINK_NUMBERS = ("joint_rotation", "planar_axis2")
_MOTION_NUMBERS = ("angular", "inverse_pivot")
# What sensors of forces need of links, besides the factors of the mass matrix.
_LOAD_NUMBERS = ("offset", "moment")
# What rows whose Jacobians change need of links, see `kernels.solver.bending`.
_BENDING_NUMBERS = ("omega", "acceleration")


def can_move_together(arrays: WorldArrays) -> bool:
    """Whether there are enough worlds to move at once, and trees of several links, where that saves time."""
    if arrays.world_count < LANES:
        return False
    return bool((arrays.model.numpy["tree_link_count"][: arrays.used["tree"]] > 1).any())


class LaneWork:
    """Arrays of several worlds, and what native code needs to move these at once; one for each thread.

    Attributes:
        record: For `Run.lanes`; valid as long as this object exists and no array of the worlds is replaced.
        sweeps: Sweeps over the rows of several worlds.
        workspaces: That of each lane.

    Args:
        arrays: Those of the worlds.
        workspace: That of the thread, which is also that of the first lane.
        plan: The parts of a step.
    """

    def __init__(self, arrays: WorldArrays, workspace: Workspace, plan: Plan) -> None:
        self.record = LaneMotion()
        others = (workspace.for_lane(detects=plan.touching) for _ in range(LANES - 1))
        self.workspaces: list[Workspace] = [workspace, *others]
        self._structs = [one.structs for one in self.workspaces]
        self.sweeps = LaneSweepWork(self._structs)
        self.record.sweeps = self.sweeps.record
        self._worlds = [_LaneWorld(structs, plan) for structs in self._structs]
        self.record.worlds = tuple(world.record for world in self._worlds)
        self.record.solving = self._worlds[0].solving
        structs = workspace.structs
        rows = {**dict.fromkeys(_OF_WORLD, 1), **arrays.used, "mass": arrays.used["block"]}
        self._plan = plan
        self._keeps_mass = plan.converged or plan.integrator not in OF_STEPS
        written = {**_WRITTEN, "scratch": (*_WRITTEN["scratch"], *([_KEPT] if self._keeps_mass else []))}
        lone = {name: structs[name].memory for name in ("model", "state", "scratch")}
        self._wide: dict[str, dict[str, Wide]] = {
            name: {
                field: widened(lone[name][field], rows[_AXES[name][field]])
                for field in (*_READ.get(name, ()), *written.get(name, ()))
            }
            for name in lone
        }
        self._wide["model"]["link"] = widened(lone["model"]["link"], rows["link"], axes=1)
        links, own = self._wide["model"]["link"].array, lone["model"]["link"]
        for field in links.dtype.names or ():
            if links.dtype[field] == own.dtype[field]:
                links[field] = own[field][: rows["link"]]
        self._time_steps = zeros((1, 1, LANES), NUMBER)
        self._lone = lone
        self._settings = structs["settings"]
        trees = list(_articulated_trees(arrays))
        gathered, scattered = list(self._gathered(trees)), list(self._scattered(trees))
        # Memory that the record points to.
        self._rows = tuple(c_array(LaneRows, len(rows), rows) for rows in (gathered, scattered))
        self.record.gathered, self.record.scattered = map(ctypes.addressof, self._rows)
        self.record.gathered_count, self.record.scattered_count = map(len, self._rows)
        self._motion = Launch(
            lane_motion_kernel,
            1,
            [
                *(self._struct(name, structs[name], lone[name]) for name in ("model", "state", "scratch")),
                array_view(self._time_steps, 2),
                rows["tree"],
            ],
        )
        self._steps_begun = zeros((1,), np.dtype(np.int64))
        self.record.steps_begun = self._steps_begun.ctypes.data
        self.record.motion = KernelCall(*self._motion.addresses())
        terms = self._wide["model"]["tree_joint_terms"].array
        self.record.joint_terms, self.record.tree_count = terms.ctypes.data, rows["tree"]

    def settings_changed(self) -> None:
        """Update the launches after the settings of kernels have changed."""
        for structs in self._structs:
            structs.changed("settings")

    @property
    def steps_begun(self) -> int:
        """How many steps of `LANES` worlds have begun together."""
        return int(self._steps_begun[0])

    def poses(self) -> np.ndarray:
        """Poses of links that were computed last, (links, 7, `LANES`)."""
        return self._wide["state"]["link_pose"].array

    def _struct(self, name: str, lone_struct: Any, lone: Mapping[str, np.ndarray]) -> Any:
        """A struct over the wide arrays, and over the topology that all worlds share."""
        shown = dict(self._wide[name])
        if name == "scratch":
            blocks = shown["block_factor"].array
            shown["entry_factor"] = Wide(blocks.reshape(-1, LANES), 2)
        shared = ("tree", "dof") if name == "model" else ()
        return struct_of(lone_struct, shown, {field: lone[field] for field in shared})

    def _gathered(self, trees: Iterable[Mapping[str, slice]]) -> Iterator[LaneRows]:
        """What is read before the kernel runs: what trees have, and what belongs to the world."""
        lone, wide = self._lone, self._wide
        for rows in trees:
            for name, fields in _READ.items():
                for field in fields:
                    if (axis := _AXES[name][field]) in rows:
                        yield rows_of_worlds(lone[name][field], wide[name][field].array, rows[axis])
            links = lone["model"]["link"][np.newaxis]
            yield rows_of_worlds(links, wide["model"]["link"].array, rows["link"], _LINK_NUMBERS)
        for field, numbers in wide["model"].items():
            if _AXES["model"][field] in _OF_WORLD:
                yield rows_of_worlds(lone["model"][field], numbers.array, slice(0, 1))
        # With explicit motion it stays 0, see `explicit_motion`.
        if self._plan.integrator in OF_STEPS:
            time_step = ctypes.addressof(self._settings) + type(self._settings).time_step.offset
            yield LaneRows((time_step,) * LANES, 0, 0, self._time_steps.ctypes.data, 0, 1, 1)

    def _scattered(self, trees: Iterable[Mapping[str, slice]]) -> Iterator[LaneRows]:
        """What is written after it."""
        wide, plan = self._wide["scratch"], self._plan
        for rows in trees:
            yield rows_of_lanes(self._scratch("link_pose_free"), self.poses(), rows["link"])
            has_sensors = self._lone["model"]["tree"]["sensor_count"][rows["tree"]].any()
            for field, axis, numbers, is_read in (
                ("dof", "active", _MOTION_NUMBERS, True),
                ("block_inverse_mass", "block", None, True),
                (
                    "link",
                    "link",
                    _LOAD_NUMBERS if has_sensors else _BENDING_NUMBERS,
                    has_sensors or plan.compliant,
                ),
                ("block_factor", "block", None, has_sensors or plan.converged),
                (_KEPT, "block", None, self._keeps_mass),
            ):
                if is_read:
                    yield rows_of_lanes(self._scratch(field), wide[field].array, rows[axis], numbers)

    def _scratch(self, field: str) -> Sequence[np.ndarray]:
        """An array of the workspace of each lane."""
        return [structs["scratch"].memory[field] for structs in self._structs]


class _LaneWorld:
    """The step of a world in a lane.

    Attributes:
        record: What native code needs of it.
        solving: Number of launches before rows are solved.
    """

    def __init__(self, structs: KernelStructs, plan: Plan) -> None:
        self._waiting = zeros((1, WAITING_SWEEPS + 1), np.dtype(np.int32))
        self._residuals = zeros((1, 1), NUMBER)
        structs.update(waiting=array_view(self._waiting, 2), residuals=array_view(self._residuals, 2))
        program, self.solving, solve = lane_program(structs, plan)
        keep = structs.launch(lane_impulses_kernel, first_world=0)
        # Unless `lane_rows_kernel` finds rows to relax with those of others, each world solves its own.
        self._waiting[0, WAITING_ROOT] = -1
        # Memory that the record points to.
        self._launches = program, solve, keep
        rows = structs["pair_rows"].memory
        self.record = LaneWorld(
            solve=world_call(solve),
            keep=world_call(keep),
            waiting=self._waiting.ctypes.data,
            residual=self._residuals.ctypes.data,
            row_numbers=structs["scratch"].memory["row"].ctypes.data,
            row_places=rows["row_place"].ctypes.data,
            row_starts=rows["row_start"].ctypes.data,
            visits=rows["visit_row"].ctypes.data,
        )
        write_program(self.record.program, program)
        self.record.program.status = structs["state"].memory["status_entry"].ctypes.data


def _articulated_trees(arrays: WorldArrays) -> Iterator[dict[str, slice]]:
    """The rows of each tree of several links, by axis; `active` are the dofs that dynamics may change."""
    of_trees = arrays.model.numpy
    for tree in range(arrays.used["tree"]):
        first = {
            name: int(of_trees[f"tree_first_{name}"][tree])
            for name in ("link", "position", "velocity", "dof", "block")
        }
        count = {name: int(of_trees[f"tree_{name}_count"][tree]) for name in ("link", "position", "dof")}
        if count["link"] > 1:
            blocks = count["dof"] * ((count["dof"] + 3) // 4)
            yield {
                "tree": slice(tree, tree + 1),
                "link": slice(first["link"], first["link"] + count["link"]),
                "position": slice(first["position"], first["position"] + count["position"]),
                # The velocities of a base come before the dofs of a fixed tree.
                "dof": slice(first["velocity"], first["dof"] + count["dof"]),
                "active": slice(first["dof"], first["dof"] + count["dof"]),
                "block": slice(first["block"], first["block"] + blocks),
            }
