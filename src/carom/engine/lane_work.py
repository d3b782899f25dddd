"""Memory for the free motion of several worlds at once.

`lane_motion_kernel` sees numbers of several worlds side by side, so it has arrays of its own: those that it
reads are gathered from the worlds before each step, and what it finds out is handed to the steps of single
worlds (`native/source/lane_motion.cpp`).
"""

from __future__ import annotations

import ctypes
from collections.abc import Iterable, Iterator, Mapping
from typing import Any, NamedTuple

import numpy as np

from carom.engine.program import Plan
from carom.layouts.programs import LANES, KernelCall, LaneMotion, LaneRows, WorldCall
from carom.model.builder import WorldArrays
from carom.native.kernels import continued_motion_kernel, free_motion_kernel, lane_motion_kernel
from carom.native.launch import KernelStructs, Launch
from carom.native.tables import array_view
from carom.native.zeros import zeros

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
# Axes with one entry.
_OF_WORLD = ("gravity", "fluid")
# Others that the kernel writes.
_WRITTEN = {"state": ("link_pose",), "scratch": ("link", "dof", "block_factor", "block_inverse_mass")}
_NUMBER = np.dtype(np.float64)
_LINK_NUMBERS = ("joint_rotation", "planar_axis2")
_MOTION_NUMBERS = ("angular", "inverse_pivot")


class _Wide(NamedTuple):
    """An array of several worlds.

    Attributes:
        array: (rows, *shape of an entry, LANES), or rows of structs with such fields.
        axes: Axes that kernels see, of which the first may be that of worlds.
    """

    array: np.ndarray
    axes: int


def can_move_together(arrays: WorldArrays, plan: Plan) -> bool:
    """Whether several worlds can move at once, and have trees of several links, which then take less time."""
    if arrays.world_count < LANES or not plan.coupled or plan.soft:
        return False
    return bool((arrays.model.numpy["tree_link_count"][: arrays.used["tree"]] > 1).any())


class LaneWork:
    """Arrays of several worlds, and what native code needs to move these at once; one for each thread.

    Attributes:
        record: For `Run.lanes`; valid as long as this object exists and no array of the worlds is replaced.
    """

    def __init__(self, arrays: WorldArrays, structs: KernelStructs) -> None:
        self.record = LaneMotion()
        rows = {**dict.fromkeys(_OF_WORLD, 1), **arrays.used}
        lone = {name: structs[name].memory for name in ("model", "state", "scratch")}
        self._wide: dict[str, dict[str, _Wide]] = {
            name: {
                field: _widened(lone[name][field], rows[field.partition("_")[0]])
                for field in (*_READ.get(name, ()), *_WRITTEN.get(name, ()))
            }
            for name in lone
        }
        self._wide["model"]["link"] = _widened(lone["model"]["link"], rows["link"], axes=1)
        links = self._wide["model"]["link"].array
        for field in links.dtype.names or ():
            if not _has_numbers(links.dtype[field]):
                links[field] = lone["model"]["link"][field][: rows["link"]]
        self._time_steps = zeros((1, 1, LANES), _NUMBER)
        self._lone = lone
        self._settings = structs["settings"]
        trees = list(_articulated_trees(arrays))
        gathered, scattered = list(self._gathered(trees)), list(self._scattered(trees))
        # Memory that the record points to.
        self._rows = (LaneRows * len(gathered))(*gathered), (LaneRows * len(scattered))(*scattered)
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
        self.record.free_motion = free_motion_kernel.address
        *call, first_world, substeps = structs.launch(continued_motion_kernel, first_world=0).addresses(
            "first_world", "substeps"
        )
        self.record.continued = WorldCall(KernelCall(*call), first_world, substeps)
        self.record.motion = KernelCall(*self._motion.addresses())
        terms = self._wide["model"]["tree_joint_terms"].array
        self.record.joint_terms, self.record.tree_count = terms.ctypes.data, rows["tree"]

    @property
    def steps_begun(self) -> int:
        """How many steps of `LANES` worlds have begun together."""
        return int(self._steps_begun[0])

    def poses(self) -> np.ndarray:
        """Poses of links that were computed last, (links, 7, `LANES`)."""
        return self._wide["state"]["link_pose"].array

    def _struct(self, name: str, lone_struct: Any, lone: Mapping[str, np.ndarray]) -> Any:
        """A struct over the wide arrays, and over the topology that all worlds share."""
        struct = type(lone_struct)()
        shown = dict(self._wide[name])
        if name == "scratch":
            blocks = shown["block_factor"].array
            shown["entry_factor"] = _Wide(blocks.reshape(-1, LANES), 2)
        for field, wide in shown.items():
            array = wide.array if wide.axes == 1 else wide.array[np.newaxis]
            setattr(struct, field, array_view(array, wide.axes))
        if name == "model":
            for field in ("tree", "dof"):
                setattr(struct, field, array_view(lone[field]))
        return struct

    def _gathered(self, trees: Iterable[Mapping[str, slice]]) -> Iterator[LaneRows]:
        """What is read before the kernel runs: what trees have, and what belongs to the world."""
        lone, wide = self._lone, self._wide
        for rows in trees:
            for name, fields in _READ.items():
                for field in fields:
                    if (axis := field.partition("_")[0]) in rows:
                        yield _rows_of(lone[name][field], wide[name][field].array, rows[axis])
            links = lone["model"]["link"][np.newaxis]
            yield _rows_of(links, wide["model"]["link"].array, rows["link"], _LINK_NUMBERS)
        for field, numbers in wide["model"].items():
            if field.partition("_")[0] in _OF_WORLD:
                yield _rows_of(lone["model"][field], numbers.array, slice(0, 1))
        time_step = ctypes.addressof(self._settings) + type(self._settings).time_step.offset
        yield LaneRows(time_step, 0, 0, self._time_steps.ctypes.data, 0, 1, 1)

    def _scattered(self, trees: Iterable[Mapping[str, slice]]) -> Iterator[LaneRows]:
        """What is written after it."""
        scratch, wide = self._lone["scratch"], self._wide["scratch"]
        for rows in trees:
            poses = self._wide["state"]["link_pose"].array
            yield _rows_of(scratch["link_pose_free"], poses, rows["link"])
            yield _rows_of(scratch["dof"], wide["dof"].array, rows["active"], _MOTION_NUMBERS)
            yield _rows_of(scratch["block_inverse_mass"], wide["block_inverse_mass"].array, rows["block"])


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


def _widened(lone: np.ndarray, count: int, axes: int = 2) -> _Wide:
    """An array of `count` rows, which has several numbers for each of those in `lone`."""
    shape = (count, *lone.shape[axes:])
    if lone.dtype == _NUMBER:
        return _Wide(zeros((*shape, LANES), _NUMBER), axes)
    fields: list[Any] = []
    for field in lone.dtype.names or ():
        kind = lone.dtype[field]
        if _has_numbers(kind):
            fields.append((field, _NUMBER, (kind.itemsize // _NUMBER.itemsize, LANES)))
        else:
            fields.append((field, kind))
    return _Wide(zeros(shape, np.dtype(fields, align=True)), axes)


def _has_numbers(kind: np.dtype[Any]) -> bool:
    """Whether a field of a struct is a number, a vector or a matrix; others are whole numbers."""
    while kind.subdtype is not None:
        kind = kind.base
    return kind == _NUMBER


def _rows_of(
    lone: np.ndarray, wide: np.ndarray, rows: slice, fields: tuple[str, str] | None = None
) -> LaneRows:
    """Some rows of an array of worlds and of that of lanes; of structs, the numbers of some fields."""
    world_stride = lone.strides[0] if len(lone) > 1 else 0
    lone, wide = lone[0, rows], wide[rows]
    if fields is None:
        return LaneRows(lone.ctypes.data, world_stride, 0, wide.ctypes.data, 0, 1, lone.size)
    first, last = fields
    begin, end = _place(lone.dtype, first)[0], _place(lone.dtype, last)[1]
    return LaneRows(
        lone.ctypes.data + begin,
        world_stride,
        lone.strides[0],
        wide.ctypes.data + _place(wide.dtype, first)[0],
        wide.strides[0],
        len(wide),
        (end - begin) // _NUMBER.itemsize,
    )


def _place(dtype: np.dtype[Any], field: str) -> tuple[int, int]:
    """Where a field of a struct begins and ends [bytes]."""
    kind, offset = (dtype.fields or {})[field][:2]
    return offset, offset + kind.itemsize
