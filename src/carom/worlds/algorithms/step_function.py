"""A step of many worlds as a function of arrays, with its vector-Jacobian products."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import suppress
from copy import copy
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from carom.checks import Array
from carom.engine.engine import Engine
from carom.engine.presence import any_absent
from carom.errors import SimulationError
from carom.layouts.codes import ASLEEP
from carom.linearization.chosen import Chosen as Parts
from carom.linearization.chosen import chosen_parts
from carom.linearization.input_values import InputValues
from carom.linearization.linearized_step import refuse_passes, refuse_substeps
from carom.linearization.row_names import StateWithoutDerivativesError
from carom.worlds.chosen import Where, world_numbers
from carom.worlds.devices import CPU
from carom.worlds.saved import SavedWorlds

if TYPE_CHECKING:
    from carom.worlds.worlds import Worlds


class StepArrays(NamedTuple):
    """What a step starts from in n worlds, or gradients by these.

    Attributes:
        positions: Coordinates that can change, (n, nq).
        velocities: (n, nv).
        activations: Activations of actuators, (n, na).
        controls: (n, nu).
        parameters: (n, np).
    """

    positions: Array
    velocities: Array
    activations: Array
    controls: Array
    parameters: Array


class StepFunction:
    """A step of some worlds as a function: the same arrays and memory give the same step, bit for bit.

    The memory is all the rest of the state: impulses and contacts of the step before, settings of motors,
    time. The worlds have the state, controls and parameters of the last call afterwards.

    Attributes:
        worlds: The worlds.
        numbers: Indices of those that take the step, (n,).
        coordinates: Names of the coordinates: three positions (x, y, z) [m] in world axes and a quaternion
            (x, y, z, w) of the inertial frame of a free base; four of a spherical joint, three of a planar
            one, one of others.
        velocities: Names of the velocities, as the second part of `LinearizedStep.states`.
        activations, controls, parameters: Names, likewise.

    Args:
        worlds: The worlds, on the processor.
        controls: Controls that are arguments, as in `Worlds.linearize`.
        parameters: Parameters that are arguments, likewise, but for inertial parameters.
        smoothing: Likewise; it only changes derivatives.
        where: Which worlds take steps: a mask (count,), their indices or a slice; None for all.

    Raises:
        ValueError: There is no such control or parameter, or a world is named twice.
        NotImplementedError: Worlds are on a GPU, have substeps or bodies that are absent; or they have
            something without exact derivatives in any step, such as armature of tendons along paths.
    """

    def __init__(
        self,
        worlds: Worlds,
        controls: Sequence[str],
        parameters: Sequence[str],
        smoothing: float,
        where: Where | None,
    ) -> None:
        if worlds.device != CPU:
            raise NotImplementedError(f"steps on {worlds.device!r} have no derivatives: use device={CPU!r}")
        if not smoothing >= 0.0:
            raise ValueError(f"smoothing must be at least 0, not {smoothing}")
        refuse_substeps(worlds._scene)
        refuse_passes(worlds._scene)
        self.worlds = worlds
        self.numbers = world_numbers(where, worlds.count)
        if len(np.unique(self.numbers)) < len(self.numbers):
            raise ValueError("where names a world twice")
        self._chosen_names = tuple(controls), tuple(parameters)
        if isinstance(controls, str) or isinstance(parameters, str):
            raise TypeError("controls and parameters must be sequences of names")
        self._smoothing = smoothing
        self._parts: Parts = chosen_parts(worlds._scene, *self._chosen_names)
        parts = self._parts
        inputs, count = parts.inputs, parts.control_count
        self._controls = InputValues(parts.space, inputs[:count])
        self._parameters = InputValues(parts.space, inputs[count:])
        dofs = len(parts.space)
        self.coordinates: tuple[str, ...] = tuple(parts.space.coordinate_names)
        self.velocities: tuple[str, ...] = parts.states[dofs : 2 * dofs]
        self.activations: tuple[str, ...] = parts.states[2 * dofs :]
        self.controls: tuple[str, ...] = parts.controls
        self.parameters: tuple[str, ...] = parts.parameters
        self._refuse()

    def of(self, worlds: Worlds) -> StepFunction:
        """The same function of other worlds with the same bodies, all of them."""
        other = copy(self)
        other.worlds, other.numbers = worlds, np.arange(worlds.count)
        return other

    def _refuse(self) -> None:
        """Refuse worlds whose steps never have derivatives, before the first of them."""
        # Other states may have them.
        with suppress(StateWithoutDerivativesError, SimulationError, ValueError):
            self.worlds._derivatives(*self._chosen_names, self._smoothing, self.numbers)

    @property
    def sizes(self) -> StepArrays:
        """Numbers of columns, (nq, nv, na, nu, np), as shapes of one world."""
        names = (self.coordinates, self.velocities, self.activations, self.controls, self.parameters)
        return StepArrays(*(np.array([len(it)]) for it in names))

    def present(self) -> tuple[SavedWorlds, StepArrays]:
        """The memory of the worlds as they are, and what a step would start from."""
        memory = self.worlds.snapshot(self.numbers)
        engine = self.worlds._engine
        values = (given.read(engine, self.numbers) for given in (self._controls, self._parameters))
        return memory, StepArrays(*self.states(memory), *values)

    def states(self, memory: SavedWorlds) -> tuple[Array, Array, Array]:
        """Positions (n, nq), velocities (n, nv) and activations (n, na) that a memory was saved with."""
        space, state = self._parts.space, memory.state
        return (
            state["position"][:, space.coordinate_rows],
            state["dof_velocity"][:, space.dofs],
            state["actuator_activation"][:, space.activations],
        )

    def step(self, memory: SavedWorlds, given: StepArrays) -> SavedWorlds:
        """Perform a step of the worlds from a state of one's choice.

        Args:
            memory: Of `present` or of the step before, of n worlds.
            given: The state, controls and parameters.

        Returns:
            The memory after it, with the state.

        Raises:
            ValueError: A value cannot be.
            NotImplementedError: A body is asleep or absent.
            carom.errors.SimulationError: A velocity is not finite after the step.
        """
        worlds, numbers = self.worlds, self.numbers
        for name, numbers_given in zip(given._fields, given, strict=True):
            if not np.isfinite(numbers_given).all():
                raise ValueError(f"{name} must be finite, but some entries are not")
        self._parameters.check(given.parameters)
        if (memory.state["tree_activity"] == ASLEEP).any():
            raise NotImplementedError(
                "steps have no derivatives where bodies are asleep: switch sleeping off"
            )
        if any_absent(worlds._engine.arrays):
            raise NotImplementedError("steps have no derivatives where bodies are absent")
        worlds._put_back(memory, numbers, np.arange(len(numbers)))
        self._write(worlds._engine, given)
        worlds.step(1, None if len(numbers) == worlds.count else numbers)
        halted = numbers[worlds.halted[numbers]]
        if len(halted):
            raise SimulationError(f"world {halted[0]} has no next step: a velocity is not finite")
        return worlds.snapshot(numbers)

    def pulled_back(
        self,
        memory: SavedWorlds,
        given: StepArrays,
        positions: Array,
        velocities: Array,
        activations: Array,
    ) -> StepArrays:
        """Gradients by the state after a step, as gradients by what the step started from.

        The step is performed again, in a copy: the worlds do not change.

        Args:
            memory: As in `step`.
            given: Likewise.
            positions: Gradients by the positions after it, (n, nq).
            velocities: Gradients by the velocities after it, (n, nv).
            activations: Gradients by the activations after it, (n, na).

        Raises:
            NotImplementedError: Something in the step has no exact derivatives; it is named.
        """
        worlds, space, numbers = self.worlds, self._parts.space, self.numbers
        copies: list[Engine] = []

        def start(engine: Engine) -> None:
            memory.put_back(engine, numbers, np.arange(len(numbers)))
            self._write(engine, given)
            copies.append(engine)

        parts, found = worlds._derivatives(*self._chosen_names, self._smoothing, numbers, start)
        rows, dofs, count = space.coordinate_rows, len(space), parts.control_count
        if not len(numbers):
            return StepArrays(*(np.zeros_like(it) for it in given))
        after = copies[0].arrays.state.numpy["position"][numbers]
        by_coordinates = np.zeros(after.shape)
        by_coordinates[:, rows] = positions
        changes = space.of_changes(after, by_coordinates)
        cotangents = np.concatenate([changes, velocities, activations], axis=1)
        by_state, by_input = found.pulled_back(cotangents)
        before = memory.state["position"].copy()
        before[:, rows] = given.positions
        return StepArrays(
            space.of_coordinates(before, by_state[:, :dofs])[:, rows],
            *(by_state[:, dofs : 2 * dofs], by_state[:, 2 * dofs :]),
            *(by_input[:, :count], by_input[:, count:]),
        )

    def _write(self, engine: Engine, given: StepArrays) -> None:
        space, numbers, state = self._parts.space, self.numbers, engine.arrays.state.numpy
        position = state["position"][numbers]
        position[:, space.coordinate_rows] = given.positions
        state["position"][numbers] = space.with_unit_quaternions(position)
        state["dof_velocity"][numbers[:, None], space.dofs] = given.velocities
        state["actuator_activation"][numbers[:, None], space.activations] = given.activations
        self._controls.write(engine, numbers, given.controls)
        self._parameters.write(engine, numbers, given.parameters)


class NamedColumns:
    """Base class of what wraps a step function for another library: the names of its columns.

    Args:
        function: The step function.
    """

    def __init__(self, function: StepFunction) -> None:
        self._function = function
        self.count: int = len(function.numbers)
        self.coordinates: tuple[str, ...] = function.coordinates
        self.velocities: tuple[str, ...] = function.velocities
        self.activations: tuple[str, ...] = function.activations
        self.controls: tuple[str, ...] = function.controls
        self.parameters: tuple[str, ...] = function.parameters
