"""The workspace of a step."""

from __future__ import annotations

from collections.abc import Mapping
from copy import copy
from typing import Any

import numpy as np

from carom.engine.contact_arrays import ContactArrays
from carom.engine.detection_capacity import scratch_capacity
from carom.layouts.contacts import FEW_SHAPES, LIST_FILTER, MAX_CORNERS, NO_LIST, Pairs
from carom.layouts.model import ENTRY_VIEWS, Scratch
from carom.layouts.newton import NEWTON_COLUMNS, NewtonWork, StageWork
from carom.layouts.pair_rows import ROW_ENTRY_VIEWS, ROWS_PER_PAIR, PairRows
from carom.layouts.soft import BUCKETS, FACES_PER_NODE, TOUCHES_PER_FACE, TOUCHES_PER_NODE, SoftWork
from carom.model.builder import WorldArrays
from carom.native.launch import KernelStructs
from carom.native.tables import ArrayTable, array_view

# What kernels are given in place of the number of shares that threads have taken, where there is one thread.
_ALONE = array_view(np.zeros((1, 0), dtype=np.int32), 2)
# Axes of `PairRows` with rows of whole worlds; all others are workspace of one island.
_OF_WORLDS = frozenset(("tree", "constraint", "contact", "order", "link", "number", "user"))
# The same of those of `Scratch` that are workspace of one island.
_OF_ISLANDS = frozenset(("row", "equation"))
# Axes of `PairRows` with rows of contacts only.
_CONTACT_AXES = frozenset(("contact", "unit", "single", "terms", "manifold", "side", "matrix"))


class Workspace:
    """Memory for the intermediate results of a step of any world: one for each thread.

    Nothing in it persists from one step to the next. If worlds are stepped in parallel, each has its own.

    Attributes:
        world_count: As given.
        scratch: Workspace of single trees.
        pairs: Workspace of collision detection.
        pair_rows: Workspace of the solver.
        soft_work: Workspace of soft bodies.
        newton_work: Workspace of the converged solver; with few rows unless constraints converge.
        stage_work: What integrators keep from stage to stage; empty with the usual one.
        structs: Structs over these and all other arrays, by the names of kernel arguments.

    Args:
        world_count: Number of worlds with rows of their own; 1 if worlds are stepped one at a time.
    """

    # Whether constraints converge, so that the solver of these needs memory.
    _converges = False

    def __init__(self, world_count: int = 1) -> None:
        self.world_count: int = world_count
        self.scratch: ArrayTable = ArrayTable(Scratch, world_count, ENTRY_VIEWS)
        self.pairs: ArrayTable = ArrayTable(Pairs, world_count)
        self.pair_rows: ArrayTable = ArrayTable(PairRows, world_count, ROW_ENTRY_VIEWS)
        self.soft_work: ArrayTable = ArrayTable(SoftWork, world_count)
        self.newton_work: ArrayTable = ArrayTable(NewtonWork, world_count)
        self.stage_work: ArrayTable = ArrayTable(StageWork, world_count)
        self.structs: KernelStructs = KernelStructs()

    def with_own_launches(self) -> Workspace:
        """The same memory with launches of its own, for another thread that steps other worlds in it."""
        other = copy(self)
        other.structs = KernelStructs()
        return other

    def for_lane(self, *, detects: bool) -> Workspace:
        """A workspace of the same size, over the same other arrays, for another world at the same time.

        That of soft bodies, which no such world has, is the same memory. If the worlds detect no collisions,
        so are that of detection, and the rows of contacts.
        """
        other = copy(self)
        other.structs = KernelStructs()
        other.scratch = self.scratch.twin()
        other.pair_rows = self.pair_rows.twin(() if detects else _CONTACT_AXES)
        if detects:
            other.pairs = self.pairs.twin()
        other.newton_work, other.stage_work = self.newton_work.twin(), self.stage_work.twin()
        other.bind(self.structs)
        return other

    def for_share(self, taken: np.ndarray, status: np.ndarray) -> Workspace:
        """A workspace for a thread that solves some islands of a world, while another one solves others.

        Only what it needs for one island at a time is its own.

        Args:
            taken: As in `share_by`.
            status: As `State.status_entry`, for this thread alone.
        """
        other = copy(self)
        other.structs = KernelStructs()
        other.scratch = self.scratch.twin(self.scratch.capacity.keys() - _OF_ISLANDS)
        other.pair_rows = self.pair_rows.twin(_OF_WORLDS)
        other.newton_work = self.newton_work.twin()
        other.bind(self.structs)
        state = self.structs["state"]
        own = type(state).from_buffer_copy(state)
        own.status_entry = array_view(status, 2)
        own.memory = {**state.memory, "status_entry": status}
        other.structs["state"] = own
        other.share_by(taken)
        return other

    def share_by(self, taken: np.ndarray) -> None:
        """Let launches that are made from now on perform shares, of which so many are taken, shape (1, n)."""
        self.structs["taken"] = array_view(taken, 2)

    @property
    def tables(self) -> tuple[ArrayTable, ...]:
        """All its tables."""
        return self.scratch, self.pairs, self.pair_rows, self.soft_work, self.newton_work, self.stage_work

    def fit(self, arrays: WorldArrays, contact_arrays: ContactArrays) -> None:
        """Grow arrays to the capacity that the other arrays require."""
        contacts, users = contact_arrays.contacts.capacity["contact"], contact_arrays.users.capacity["user"]
        equations = self.room_for_equations(arrays, contact_arrays)
        self.scratch.reserve({**arrays.used, "user": users, "equation": equations})
        overlaps = contact_arrays.contacts.capacity["overlap"]
        self.pairs.reserve(self.room_for_detection(contact_arrays.shapes.shape_count, contacts))
        room = self.pairs.capacity["pair"]
        # The neighbour list also has pairs that are not near yet; among few shapes it may have all pairs.
        few = min(contact_arrays.shapes.shape_count, FEW_SHAPES)
        listed = max(2 * room, few * (few - 1) // 2)
        self.pairs.reserve({"queue": room + overlaps, "listed": listed})
        self.pair_rows.reserve(
            {
                "tree": arrays.model.capacity["tree"],
                "contact": contacts,
                "unit": contacts,
                "link": arrays.model.capacity["link"],
                "number": arrays.model.capacity["link"],
                "order": max(overlaps, arrays.model.capacity["constraint"]),
                "matrix": contacts,
                "manifold": contacts // 2,
                "side": 2 * (contacts // 2),
                "constraint": arrays.model.capacity["constraint"],
                "visit": self.scratch.capacity["row"] + ROWS_PER_PAIR * users,
                "user": users,
            }
        )
        if contact_arrays.soft.bodies:
            nodes = arrays.state.capacity["node"]
            faces = contact_arrays.soft.table.capacity["face"]
            self.soft_work.reserve(
                {
                    "node": nodes,
                    "face": faces,
                    "near": FACES_PER_NODE * nodes,
                    "bucket": BUCKETS,
                    "polytope": 2 * MAX_CORNERS,
                    "anchor": contact_arrays.soft.table.capacity["anchor"],
                    "dof": arrays.state.capacity["dof"],
                    "tree": arrays.model.capacity["tree"],
                }
            )
            # The rows of faces begin behind those of all nodes that there is room for.
            room = self.soft_work.capacity["node"]
            self.soft_work.reserve({"touch": TOUCHES_PER_NODE * room + TOUCHES_PER_FACE * faces})

    def fit_laws(self, arrays: WorldArrays, converges: bool, staged: bool) -> None:
        """The same of the converged solver, and of integrators of several stages, if they are used."""
        if converges:
            self._fit_converged(arrays)
        if converges or staged:
            self.scratch.reserve({"mass": arrays.used["block"]})
        if staged:
            state = arrays.state.capacity
            self.stage_work.reserve({axis: state[axis] for axis in ("position", "dof", "actuator")})

    def _fit_converged(self, arrays: WorldArrays) -> None:
        self._converges = True
        blocks = self.scratch.capacity["delta"]
        self.newton_work.reserve(
            {
                "count": NEWTON_COLUMNS,
                "tree": arrays.model.capacity["tree"],
                "neighbour": 2 * self.pair_rows.capacity["contact"],
                "newton": self.scratch.capacity["row"] + self.pair_rows.capacity["row"],
                "vector": 4 * blocks,
                "matrix": 64 * blocks,
                "sliding": self.pair_rows.capacity["row"],
                "system": 1024,
                "dof": arrays.state.capacity["dof"],
            }
        )

    def room_for_equations(self, arrays: WorldArrays, contact_arrays: ContactArrays) -> int:
        """Number of blocks for rows that are solved for at once, see `kernels.convergence.active_set`."""
        return 2 * arrays.used["block"]

    def room_for_detection(self, shape_count: int, contacts: int) -> dict[str, int]:
        """Number of rows that collision detection needs, by axis of `Pairs`, except its axis `pair`."""
        return scratch_capacity(shape_count, contacts)

    def grow(self, pairs: int, *, rows: bool) -> None:
        """Grow the arrays to a number of pairs of shapes; with `rows`, double the number of solver rows."""
        self.pairs.reserve({"pair": pairs})
        if rows:
            capacity = self.pair_rows.capacity
            axes = "row", "jacobian", "matrix", "single"
            self.pair_rows.reserve({axis: 2 * capacity[axis] for axis in axes})
            if self._converges:
                solving = self.newton_work.capacity
                self.newton_work.reserve({axis: 2 * solving[axis] for axis in ("matrix", "system")})

    def forget_neighbours(self) -> None:
        """Make the neighbour lists anew in the next step, because other shapes may collide."""
        # A workspace without pairs, before the first step, has no such column.
        self.pairs.numpy["count_pairs"][:, LIST_FILTER : LIST_FILTER + 1] = NO_LIST

    def bind(self, shared: Mapping[str, Any]) -> KernelStructs:
        """Structs over the current arrays of this workspace, and over those that all workspaces share."""
        self.structs.update(
            shared,
            scratch=self.scratch.struct(),
            pairs=self.pairs.struct(),
            pair_rows=self.pair_rows.struct(),
            soft_work=self.soft_work.struct(),
            newton_work=self.newton_work.struct(),
            stage_work=self.stage_work.struct(),
            taken=_ALONE,
        )
        return self.structs
