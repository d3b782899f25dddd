"""Tasks other than steps, which run in all worlds."""

from __future__ import annotations

from collections.abc import Callable
from typing import Protocol

import numpy as np

from carom.engine.interpreter import Stepper
from carom.engine.program import Program
from carom.model.builder import WorldArrays
from carom.native.launch import KernelStructs, Launch


class Runner(Protocol):
    """What a task needs of the engine."""

    arrays: WorldArrays
    changes: int

    def load(self, interpreters: list[Stepper], program: Callable[[KernelStructs], Program]) -> None:
        """Give each interpreter its program, over the structs of its thread."""
        ...

    def run(self, interpreters: list[Stepper], worlds: np.ndarray | None = None, **scalars: int) -> None:
        """Run the programs in some worlds, by index; None for all."""
        ...


class Task:
    """A task that runs in all worlds when it is called; see `Engine.task`."""

    def __init__(
        self,
        engine: Runner,
        make_launches: Callable[[KernelStructs], list[Launch]],
        interpreters: list[Stepper],
        worlds_per_thread: int,
    ) -> None:
        self._engine = engine
        self._make_launches = make_launches
        self._interpreters = interpreters
        self._worlds_per_thread = worlds_per_thread
        self._made_at = -1

    def renew(self) -> None:
        """Make the launches again before the next call."""
        self._made_at = -1

    def __call__(self, worlds: np.ndarray | None = None) -> None:
        """Run it in some worlds, by index; None for all."""
        if self._made_at != self._engine.changes:
            self._engine.load(self._interpreters, self._program)
            self._made_at = self._engine.changes
        count = self._engine.arrays.world_count if worlds is None else len(worlds)
        threads = max(1, count // self._worlds_per_thread)
        self._engine.run(self._interpreters[:threads], worlds)

    def _program(self, structs: KernelStructs) -> Program:
        return Program(begin=[], detection=self._make_launches(structs), motion=[], end=[], abandon=[])
