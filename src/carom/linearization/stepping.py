"""Steps of copies of a world, from states and inputs of one's choice."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from copy import deepcopy
from typing import TYPE_CHECKING

import numpy as np

from carom.engine.engine import Engine
from carom.engine.workspace import Workspace
from carom.errors import SimulationError
from carom.layouts.contacts import OVERLAPS, THERE
from carom.layouts.status import STATUS, WELL
from carom.linearization.fields import Fields
from carom.linearization.input_values import JOINT_TERMS
from carom.native.block_copies import BlockCopies

if TYPE_CHECKING:
    from carom.engine.parameters import EngineParameters
    from carom.linearization.inputs import Input
    from carom.native.tables import ArrayTable
    from carom.scene.core.world_core import WorldCore


class _OwnRows(Engine):
    """An engine whose worlds have rows of their own in the workspace: results of steps are read there."""

    moves_together = False

    def _make_workspaces(self, threads: int) -> list[Workspace]:
        first = Workspace(self.arrays.world_count)
        return [first, *(first.with_own_launches() for _ in range(threads - 1))]


class Copies:
    """Copies of a world, all in its state at first, or of the worlds of an engine.

    Attributes:
        engine: Their engine.
        state: Fields of their states.
        model: Fields of their models.
        count: Number of worlds.
        linearizer: What has linearised steps of them last: a `StepLinearizer`.
    """

    def __init__(self, world: WorldCore, count: int) -> None:
        """Make copies of a world, which are stepped on one thread."""
        world.prepare()
        self.parameters: EngineParameters = world.parameters
        self._unspent = world.unspent_time
        arrays = world.arrays.repeated(count, world.contact_arrays.user_count)
        self._set(_OwnRows(arrays, world.contact_arrays.repeated(arrays), 1))

    @classmethod
    def of_engine(cls, engine: Engine, parameters: EngineParameters, threads: int) -> Copies:
        """A copy of each world of an engine, in its state and with its parameters."""
        made = cls.__new__(cls)
        made.parameters, made._unspent = parameters, 0.0
        made._set(_OwnRows(*deepcopy((engine.arrays, engine.contact_arrays)), threads))
        made.follow(engine, 0.0)
        return made

    def _set(self, engine: Engine) -> None:
        self.engine: Engine = engine
        engine.update_settings(self.parameters)
        self.state: dict[str, np.ndarray] = engine.arrays.state.numpy
        self.model: dict[str, np.ndarray] = engine.arrays.model.numpy
        self.count = engine.arrays.world_count
        self.linearizer: object = None
        self._forces: list[tuple[str, np.ndarray]] = []
        self._blocks: tuple[list[int], BlockCopies] | None = None
        # Of the state that was followed last.
        self._asleep: tuple[bytes, ...] = ()

    def follow(self, other: Engine, unspent_time: float) -> bool:
        """Give copies the states and parameters of the worlds of an engine; False if they do not fit."""
        mine, its = self.engine.contact_arrays, other.contact_arrays
        room = mine.contacts.capacity
        counts = its.contacts.numpy["count_contacts"]
        if greatest(counts[:, THERE]) > room["contact"] or greatest(counts[:, OVERLAPS]) > room["overlap"]:
            return False
        self._unspent = unspent_time
        self._forces = []
        self.engine.update_settings(self.parameters)
        tables = (
            *((self.engine.arrays.state, other.arrays.state), (self.engine.arrays.model, other.arrays.model)),
            *((mine.contacts, its.contacts), (mine.users, its.users)),
            (mine.shapes.table, its.shapes.table),
        )
        made_for = [table.replacements for pair in tables for table in pair]
        if self._blocks is None or self._blocks[0] != made_for:
            self._blocks = made_for, BlockCopies(_pairs(tables))
        self._blocks[1]()
        self.engine.status[:] = 0
        mine.forget_order()
        asleep = tuple(it.tobytes() for it in self._activity())
        if asleep != self._asleep:
            self.engine.activity_changed()
            self._asleep = asleep
        return True

    def _activity(self) -> tuple[np.ndarray, ...]:
        """What says whether bodies sleep, may do so, or are absent."""
        state = self.engine.arrays.state.numpy
        return (
            state["tree_activity"],
            state["tree_wants_sleep"],
            self.engine.arrays.model.numpy["tree_can_sleep"],
        )

    def scratch(self, world: int) -> Fields:
        """Intermediate results of the last step of a world."""
        return Fields(self.engine.workspace.scratch, world)

    def change(self, given: Input, worlds: np.ndarray, changes: np.ndarray) -> None:
        """Add changes (m,) to an input in m of the worlds."""
        if given.table == "state":
            self.state[given.field][(worlds, *given.place)] += given.scale * changes
        else:
            self.engine.spread(given.table, given.field)
            table = self.engine.table_of(given.table)
            for place in given.places():
                table.numpy[given.field][(worlds, *place)] += given.scale * changes
            table.written(given.field)
        if given.field in JOINT_TERMS:
            self.engine.spread("model", "tree_joint_terms")
            self.model["tree_joint_terms"][:] = 1.0
            self.engine.arrays.model.written("tree_joint_terms")

    def keep_forces(self) -> None:
        """Apply the present forces and torques on joints and links in every step from now on."""
        state = self.engine.arrays.state.numpy
        self._forces = [(name, state[name].copy()) for name in ("dof_torque", "link_wrench")]

    def apply_forces(self) -> None:
        """Apply the forces that are kept."""
        state = self.engine.arrays.state.numpy
        for name, forces in self._forces:
            state[name][:] = forces

    def step(self, worlds: np.ndarray | None = None) -> None:
        """Perform a step of some of the worlds; None for all.

        Raises:
            SimulationError: A velocity is not finite.
        """
        self.apply_forces()
        due, self._unspent = self.parameters.substeps_due(self._unspent)
        if due == 1 and worlds is None:
            if self.engine.step_all():
                return
        else:
            self.engine.step([due], worlds)
        if greatest(self.engine.status[:, STATUS]) > WELL:
            raise SimulationError("a step cannot be linearised: a velocity is not finite")


def _pairs(tables: Iterable[tuple[ArrayTable, ArrayTable]]) -> Iterator[tuple[np.ndarray, np.ndarray]]:
    """Arrays (source, target) of tables (mine, its): of shapes only surfaces, and what belongs to links."""
    for mine, its in tables:
        of_shapes = "shape" in mine.capacity
        for own, other in zip(mine.row_fields, its.row_fields, strict=True):
            if not of_shapes or own.axis == "link" or own.per_world:
                yield other.array, own.array


def greatest(numbers: np.ndarray) -> int:
    """The greatest of some whole numbers (m,), sooner for one of them."""
    return int(numbers[0]) if len(numbers) == 1 else int(numbers.max())


def made_for(world: WorldCore) -> tuple[object, ...]:
    """What is the same as long as a copy can follow its world."""
    counts = world.contact_arrays.user_count, *world.arrays.used.values()
    return world.engine, world.engine.changes, counts


def copy_of(world: WorldCore) -> Copies:
    """One copy of a world, in its present state; it is kept for the next call."""
    world.prepare()
    now = made_for(world)
    kept: tuple[tuple[object, ...], Copies] | None = world.kept_linearization.get(Copies)
    if kept is not None and kept[0] == now and kept[1].follow(world.engine, world.unspent_time):
        return kept[1]
    copies = Copies(world, 1)
    world.kept_linearization[Copies] = made_for(world), copies
    return copies
