"""Dynamics, Jacobians and derivatives of a body in many worlds: a native call on each thread."""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property
from typing import Any

import numpy as np

from carom.algorithms.mechanism import Mechanism
from carom.algorithms.nodes import body_nodes
from carom.algorithms.not_finite import reason
from carom.algorithms.sweeps import sweep_table
from carom.engine.engine import Engine
from carom.engine.world_calls import WorldCalls
from carom.layouts.codes import BASE_POSITIONS
from carom.layouts.mechanism import MechanismBatch
from carom.native.kernels import (
    Kernel,
    forces_in_worlds_kernel,
    jacobians_in_worlds_kernel,
    mass_matrices_in_worlds_kernel,
)
from carom.native.launch import Launch
from carom.native.tables import put_array, put_zeros
from carom.scene.core.body_core import BodyCore
from carom.worlds.algorithms.varied import NodeParameters, VariedParameters

_POINT = 3
_JACOBIAN_ROWS = 6


class MechanicsBatch:
    """The equations of motion of a body in the worlds of an engine.

    Args:
        body: The body in the scene that the worlds are copies of.
        engine: The engine.
        threads: Number of threads.

    Raises:
        DescriptionError: The file of a collision mesh cannot be used.
    """

    def __init__(self, body: BodyCore, engine: Engine, threads: int) -> None:
        nodes, ends = body_nodes(body)
        self._body, self._ends = body, ends
        self._varied = VariedParameters(engine, body, ends)
        self._make: Callable[[], Mechanism] = lambda: Mechanism(nodes, ends, free=not body.fixed_base)
        self._mechanisms = [self._make() for _ in range(threads)]
        self._calls = WorldCalls(threads)
        self.dofs: int = self._mechanisms[0].dofs
        """Number of velocity coordinates, those of a free base included."""
        self.links: int = len(ends)
        """Number of links, the base included."""

    def forces(self, questions: np.ndarray, worlds: np.ndarray) -> np.ndarray:
        """Generalized forces (n, dofs) for questions of `motion_kernel`, (n, numbers), in some worlds.

        Raises:
            ValueError: In a world they are not finite.
        """
        kernel, row = forces_in_worlds_kernel, questions.shape[1]
        return self._ask(kernel, questions, worlds, (self.dofs,), "force", row, varied=True)

    def mass_matrices(self, positions: np.ndarray, worlds: np.ndarray) -> np.ndarray:
        """Mass matrices (n, dofs, dofs) at joint positions (n, coordinates), in some worlds.

        Raises:
            ValueError: In a world one is not finite.
        """
        kernel, shape = mass_matrices_in_worlds_kernel, (self.dofs, self.dofs)
        return self._ask(kernel, positions, worlds, shape, "mass matrix", varied=True)

    def jacobians(self, link: int, points: np.ndarray, positions: np.ndarray) -> np.ndarray:
        """Jacobians (n, 6, dofs), linear before angular, of points (n, 3) on a link, as `Mechanism.jacobian`.

        Raises:
            ValueError: In a world one is not finite.
        """
        kernel, questions = jacobians_in_worlds_kernel, np.concatenate([points, positions], axis=1)
        shape = (_JACOBIAN_ROWS, self.dofs)
        return self._ask(kernel, questions, np.arange(len(points)), shape, "Jacobian", 1 + link)

    def sweep(
        self, kernel: Kernel, questions: np.ndarray, worlds: np.ndarray, size: int, name: str, *numbers: int
    ) -> np.ndarray:
        """Answers (n, size) of a kernel that takes a `SweepTable`, to questions (n, numbers), in some worlds.

        It gets `numbers`, or else whether masses, inertias and armature differ between worlds.

        Raises:
            ValueError: In a world an answer is not finite.
        """
        if size == 0:
            return np.zeros((len(worlds), 0))
        return self._ask(
            *(kernel, questions, worlds, (size,), name, *numbers),
            varied=not numbers,
            tables=self._sweep_tables,
        )

    def sweep_structs(self) -> tuple[list[list[Any]], NodeParameters | None]:
        """The structs of the mechanism and of its sweeps on each thread, and parameters if worlds differ."""
        found = self._varied()
        mechanisms = self._mechanisms if found is None else self._armed_mechanisms
        tables = self._sweep_tables
        return [[*each.structs, table] for each, table in zip(mechanisms, tables, strict=True)], found

    @cached_property
    def _armed_mechanisms(self) -> list[Mechanism]:
        """Those into which kernels write the parameters of worlds."""
        armed = [self._make() for _ in self._mechanisms]
        for each in armed:
            each.structs[0].has_armature = 1
        return armed

    @cached_property
    def _sweep_tables(self) -> list[Any]:
        return [sweep_table(self._body, each, self._ends) for each in self._mechanisms]

    def _ask(
        self,
        kernel: Kernel,
        questions: np.ndarray,
        worlds: np.ndarray,
        shape: tuple[int, ...],
        name: str,
        *numbers: int,
        varied: bool = False,
        tables: list[Any] | None = None,
    ) -> np.ndarray:
        """The answers of a kernel, which gets `numbers`, and for `varied` also whether worlds differ.

        If there are tables, each thread has one of its own.
        """
        count = len(worlds)
        batch, mechanisms = MechanismBatch(), self._mechanisms
        put_array(batch, "question", questions)
        answer = put_zeros(batch, "answer", count * int(np.prod(shape))).reshape(count, *shape)
        found = self._varied() if varied else None
        if varied:
            mechanisms = self._put_parameters(batch, found, worlds)
            numbers = (*numbers, int(found is not None))
        more = [[]] * len(mechanisms) if tables is None else [[table] for table in tables]
        launches = [
            [Launch(kernel, 1, [*each.structs, *own, batch, *numbers, 0])]
            for each, own in zip(mechanisms, more, strict=True)
        ]
        self._calls.run(count, launches)
        # The kernels make the first number NaN if any is not finite.
        wrong = np.flatnonzero(np.isnan(answer.reshape(count, int(np.prod(shape)))[:, :1]))
        if len(wrong):
            why = "look at the arguments there" if tables is None else self._reason(questions[wrong[0]])
            raise ValueError(f"in world {worlds[wrong[0]]} the {name} is not finite: {why}")
        return answer

    def _reason(self, question: np.ndarray) -> str:
        """Why the answer to a question of `Sweeps` is not finite."""
        placed, *rates = np.split(question[_POINT:], [-2 * self.dofs, -self.dofs])
        return reason(self._body, placed[BASE_POSITIONS if self._body.fixed_base else 0 :], *rates)

    def _put_parameters(self, batch: Any, found: Any, worlds: np.ndarray) -> list[Mechanism]:
        """Give the kernels the parameters of some worlds; returns the mechanisms to use."""
        for name in ("mass", "moment", "inertia", "armature"):
            if found is None:
                put_zeros(batch, name, 0)
            else:
                put_array(batch, name, getattr(found, name)[worlds])
        if found is None:
            return self._mechanisms
        return self._armed_mechanisms
