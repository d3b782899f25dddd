"""Steps of copies of a world, from states and inputs of one's choice."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING
from weakref import WeakKeyDictionary

import numpy as np

from carom.engine.engine import Engine
from carom.errors import SimulationError
from carom.layouts.status import STATUS, WELL

if TYPE_CHECKING:
    from carom.linearization.inputs import Input
    from carom.linearization.tangent import TangentSpace
    from carom.world.world import World

# Parameters without effect in trees where all such terms are 0, unless this field says otherwise.
_JOINT_TERMS = ("dof_armature", "dof_stiffness", "dof_implicit_damping")


class Copies:
    """Copies of a world, all in its state at first, on one thread.

    Attributes:
        engine: Their engine.
        state: Fields of their states.
        model: Fields of their models.
    """

    def __init__(self, world: World, count: int) -> None:
        world.prepare()
        self._parameters = world.parameters
        self._unspent = world.unspent_time
        arrays = world.arrays.repeated(count)
        self.engine: Engine = Engine(arrays, world.contact_arrays.repeated(arrays), 1)
        self.engine.update_settings(world.parameters)
        self.state: dict[str, np.ndarray] = arrays.state.numpy
        self.model: dict[str, np.ndarray] = arrays.model.numpy
        self.count = count
        self._forces: list[tuple[str, np.ndarray]] = []

    def follow(self, world: World) -> bool:
        """Give one copy the present state and parameters of its world; False if it no longer fits."""
        mine, its = self.engine.contact_arrays, world.contact_arrays
        room = mine.contacts.numpy
        if (
            len(room["contact_distance"][0]) < its.contact_count
            or len(room["overlap_place"][0]) < its.overlap_count
        ):
            return False
        self._unspent = world.unspent_time
        self._forces = []
        for table, other, names in (
            (self.engine.arrays.state, world.arrays.state, ""),
            (self.engine.arrays.model, world.arrays.model, ""),
            (mine.contacts, its.contacts, ""),
            (mine.users, its.users, ""),
            (mine.shapes.table, its.shapes.table, "link_"),
        ):
            for name, array in table.numpy.items():
                if name.startswith(names):
                    _copy(other.numpy[name], array)
        self.engine.status[:] = 0
        mine.forget_order()
        self.engine.activity_changed()
        self.engine.update_settings(world.parameters)
        return True

    def change(self, given: Input, worlds: np.ndarray, changes: np.ndarray) -> None:
        """Add changes (m,) to an input in m of the worlds."""
        if given.table == "state":
            self.state[given.field][(worlds, *given.place)] += given.scale * changes
        else:
            self.engine.spread(given.table, given.field)
            table = self.engine.table_of(given.table)
            table.numpy[given.field][(worlds, *given.place)] += given.scale * changes
            table.written(given.field)
        if given.field in _JOINT_TERMS:
            self.engine.spread("model", "tree_joint_terms")
            self.model["tree_joint_terms"][:] = 1.0
            self.engine.arrays.model.written("tree_joint_terms")

    def keep_forces(self) -> None:
        """Apply the present forces and torques on joints and links in every step from now on."""
        self._forces = [(name, self.state[name].copy()) for name in ("dof_torque", "link_wrench")]

    def apply_forces(self) -> None:
        """Apply the forces that are kept."""
        for name, forces in self._forces:
            self.engine.arrays.state.numpy[name][:] = forces

    def step(self) -> None:
        """Perform a step.

        Raises:
            SimulationError: A velocity is not finite.
        """
        self.apply_forces()
        due, self._unspent = self._parameters.substeps_due(self._unspent)
        self.engine.step([due])
        if (self.engine.status[:, STATUS] > WELL).any():
            raise SimulationError("a step cannot be linearised: a velocity is not finite")


def _copy(source: np.ndarray, target: np.ndarray) -> None:
    """Copy as much as there is room for: the rest of the rows is not in use."""
    if source.shape == target.shape:
        target[:] = source
    else:
        own = tuple(slice(min(pair)) for pair in zip(source.shape, target.shape, strict=True))
        target[own] = source[own]


_kept: WeakKeyDictionary[World, tuple[tuple[object, ...], Copies]] = WeakKeyDictionary()


def _made_for(world: World) -> tuple[object, ...]:
    """What is the same as long as a copy can follow its world."""
    counts = world.contact_arrays.user_count, *world.arrays.used.values()
    return world.engine, world.engine.changes, counts


def copy_of(world: World) -> Copies:
    """One copy of a world, in its present state; it is kept for the next call."""
    world.prepare()
    made_for = _made_for(world)
    kept = _kept.get(world)
    if kept is not None and kept[0] == made_for and kept[1].follow(world):
        return kept[1]
    copies = Copies(world, 1)
    _kept[world] = _made_for(world), copies
    return copies


def differences(
    world: World, space: TangentSpace, inputs: Sequence[Input], steps: int, size: float
) -> tuple[np.ndarray, np.ndarray]:
    """Central differences of the state after steps.

    Args:
        world: The world.
        space: Its tangent space.
        inputs: Controls and parameters.
        steps: Number of steps.
        size: Size of the changes; those of inputs are relative if the input is greater than 1.

    Returns:
        Derivatives by the state (nx, nx), and by the inputs (nx, inputs).
    """
    dofs, active = len(space), len(space.activations)
    width = 2 * dofs + active
    total = width + len(inputs)
    copies = Copies(world, 2 * total)
    state = copies.state
    sizes = np.full(total, size)
    signed = np.concatenate([np.eye(total), -np.eye(total)]) * size
    state["position"][:] = space.moved(state["position"], signed[:, :dofs])
    state["dof_velocity"][:, space.dofs] += signed[:, dofs : 2 * dofs]
    if active:
        state["actuator_activation"][:, space.activations] += signed[:, 2 * dofs : width]
    for number, given in enumerate(inputs, width):
        table = state if given.table == "state" else copies.engine.table_of(given.table).numpy
        sizes[number] *= max(1.0, abs(float(table[given.field][(0, *given.place)]) / given.scale))
        change = sizes[number] * np.array([1.0, -1.0])
        copies.change(given, np.array([number, total + number]), change)
    copies.keep_forces()
    for _ in range(steps):
        copies.step()
    # Arrays are replaced where they were too short.
    state = copies.engine.arrays.state.numpy
    position, velocity = state["position"], state["dof_velocity"][:, space.dofs]
    change = np.zeros((total, width))
    change[:, :dofs] = space.difference(position[:total], position[total:])
    change[:, dofs : 2 * dofs] = velocity[:total] - velocity[total:]
    if active:
        activation = state["actuator_activation"][:, space.activations]
        change[:, 2 * dofs :] = activation[:total] - activation[total:]
    found = (change / (2.0 * sizes[:, None])).T
    return found[:, :width], found[:, width:]
