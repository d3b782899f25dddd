"""A step function for batches: many states of the same worlds in one call."""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Callable

import numpy as np

from carom.worlds.algorithms.packed import Packing
from carom.worlds.algorithms.step_function import StepArrays, StepFunction
from carom.worlds.checkpoint import parameters_of, set_parameters
from carom.worlds.worlds import Worlds

# Of a step function: packed memories (m, bytes) and arrays (m, columns) as other arrays (m, columns).
_Some = Callable[[StepFunction, np.ndarray, list[np.ndarray]], list[np.ndarray]]
# So many worlds take a step together at most: more would only need more memory.
_TOGETHER = 4096
# Batches of so many sizes keep their worlds.
_KEPT = 4


class RepeatedSteps:
    """Steps of a step function from b states at once, each of all its n worlds.

    A batch is stepped, and pulled back, by worlds of its own, b copies of those n, so all cores have work.
    They are made when a batch of a new size comes, and have the parameters that the worlds have at each call.

    Args:
        function: The step function.
        packing: How its memory is packed.
    """

    def __init__(self, function: StepFunction, packing: Packing) -> None:
        self._function, self._packing = function, packing
        self._made: OrderedDict[int, StepFunction] = OrderedDict()

    def step(self, memory: np.ndarray, given: StepArrays) -> tuple[np.ndarray, ...]:
        """The states after a step, and the memories: arrays (..., n, columns), of arrays likewise.

        Raises:
            ValueError, NotImplementedError, carom.errors.SimulationError: As `StepFunction.step`; worlds of a
                batch are counted through.
        """

        def some(function: StepFunction, packed: np.ndarray, arrays: list[np.ndarray]) -> list[np.ndarray]:
            after = function.step(self._packing.unpack(packed, function.numbers), StepArrays(*arrays))
            return [*function.states(after), self._packing.pack(after)]

        return self._through(some, memory, given)

    def pulled_back(
        self, memory: np.ndarray, given: StepArrays, *gradients: np.ndarray
    ) -> tuple[np.ndarray, ...]:
        """Gradients by the states after a step as those by its arguments: arrays (..., n, columns).

        Raises:
            NotImplementedError: As `StepFunction.pulled_back`.
        """
        parts = len(given)

        def some(function: StepFunction, packed: np.ndarray, arrays: list[np.ndarray]) -> list[np.ndarray]:
            start = self._packing.unpack(packed, function.numbers)
            return list(function.pulled_back(start, StepArrays(*arrays[:parts]), *arrays[parts:]))

        return self._through(some, memory, (*given, *gradients))

    def _through(
        self, some: _Some, memory: np.ndarray, arrays: tuple[np.ndarray, ...]
    ) -> tuple[np.ndarray, ...]:
        """Call something with as many elements of the batch as fit together, and join what it returns."""
        batch, worlds = memory.shape[:-2], len(self._function.numbers)
        total = int(np.prod(batch, dtype=np.int64))
        flat = [np.reshape(it, (total, worlds, it.shape[-1])) for it in (memory, *arrays)]
        most = max(_TOGETHER // max(worlds, 1), 1)
        parts: list[list[np.ndarray]] = []
        for first in range(0, total, most):
            rows = [it[first : first + most] for it in flat]
            size = len(rows[0])
            function = self._function if size == 1 else self._repeated(size)
            packed, *given = (np.ascontiguousarray(it.reshape(size * worlds, it.shape[-1])) for it in rows)
            parts.append(some(function, packed, given))
        return tuple(
            np.ascontiguousarray(np.concatenate(own)).reshape(*batch, worlds, own[0].shape[-1])
            for own in zip(*parts, strict=True)
        )

    def _repeated(self, times: int) -> StepFunction:
        """The step function of so many copies of the worlds, with their present parameters."""
        function = self._function
        made = self._made.pop(times, None)
        if made is None:
            source = function.worlds
            first = source.extract(int(function.numbers[0]))
            made = function.of(Worlds(first, times * len(function.numbers), threads=source._thread_count))
        self._made[times] = made
        while len(self._made) > _KEPT:
            self._made.popitem(last=False)
        rows = np.tile(function.numbers, times)
        set_parameters(
            made.worlds._engine,
            {
                table: {name: array[rows] if len(array) > 1 else array for name, array in fields.items()}
                for table, fields in parameters_of(function.worlds._engine).items()
            },
        )
        return made
