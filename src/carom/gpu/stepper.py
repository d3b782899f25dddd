"""Steppers that run programs of fine launches on a device."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np

from carom.engine.interpreter import Stepper
from carom.engine.program import Program
from carom.gpu.workspace import DeviceStructs
from carom.layouts.parallel import BEGIN, GO_ON, RESUME, STAY
from carom.layouts.status import STEPS_DONE


class _Asked:
    """The numbers that a run of a stepper uses; see `carom.engine.interpreter`."""

    def __init__(self, world_count: int) -> None:
        self.program = Program([], [], [], [], [])
        self._world_count = world_count
        self._step_count = 1
        self._resumed = 0

    def ask(self, **asked: Any) -> None:
        """Set `world_count`, `step_count` or `resumed` for all later runs; other numbers are ignored."""
        self._world_count = asked.get("world_count", self._world_count)
        self._step_count = asked.get("step_count", self._step_count)
        self._resumed = asked.get("resumed", self._resumed)


class StepStepper(_Asked, Stepper):
    """Steps all worlds at once, with one captured graph for each number of substeps.

    The status of the worlds is read after all steps have been launched: first one number for all of them, and
    only if it is not 0 the status of each world, on the host. The indices of `worlds` and the numbers of
    substeps `due` in each step are changed in place; with 0 substeps, only contacts are found.
    """

    def __init__(
        self,
        structs: DeviceStructs,
        state: Mapping[str, Any],
        status: np.ndarray,
        worlds: np.ndarray,
        due: np.ndarray,
    ) -> None:
        super().__init__(len(worlds))
        self._structs = structs
        self._state = state
        self._status = status
        self._worlds = worlds
        self._due = due
        self._graphs: dict[int, Callable[[], None]] = {}
        self._ask: Callable[[], None] = _nothing
        self.run: Callable[[], None] = self._run

    def load(self, program: Program) -> None:  # noqa: D102
        self._graphs.clear()
        worlds = (self._structs.extent.worlds,)
        self._ask = self._structs.launch_over("parallel.runs", "ask_kernel", worlds)
        self.program = program

    def _run(self) -> None:
        worlds = self._worlds[: self._world_count]
        if self._resumed:
            begun = self._status[worlds, STEPS_DONE]
            first = int(begun.min(initial=self._step_count))
            for step in range(first, self._step_count):
                joining = worlds[begun == step]
                if len(joining):
                    self._tell(RESUME, joining, STAY if step == first else GO_ON)
                self._step(int(self._due[step]))
        else:
            self._tell(BEGIN, worlds, STAY)
            for step in range(self._step_count):
                self._step(int(self._due[step]))
        self._read(worlds)

    def _tell(self, part: int, worlds: np.ndarray, others: int) -> None:
        """Set what some worlds, and all others, do in the following steps: `BEGIN`, `RESUME` and so on."""
        parts = np.full(len(self._status), others, dtype=np.int32)
        parts[worlds] = part
        if not np.array_equal(parts, self._structs.parts):
            self._structs.arrays["run"]["world_part"][...] = parts
            self._structs.parts = parts
        self._ask()

    def _read(self, worlds: np.ndarray) -> None:
        trouble = self._structs.arrays["run"]["trouble"]
        if int(np.asarray(trouble)[0]) == 0:
            self._status[worlds] = 0
            self._status[worlds, STEPS_DONE] = self._step_count
            return
        trouble[0] = 0
        self._status[worlds] = np.asarray(self._state["status_entry"])[worlds]

    def _step(self, substeps: int) -> None:
        """Launch a step; the first step with a given number of substeps is captured, if the device can."""
        program = self.program
        for launch in program.begin:
            launch.replace("substeps", substeps)  # type: ignore[attr-defined]
        if substeps not in self._graphs:
            rounds = [*program.detection, *program.motion] * substeps if substeps else program.detection
            launches = [*program.begin, *rounds, *program.end]
            self._graphs[substeps] = self._structs.device.capture(lambda: _perform(launches))
        self._graphs[substeps]()


class TaskStepper(_Asked, Stepper):
    """Runs launches with one thread per world, for some of the worlds, whose indices are changed in place."""

    def __init__(self, worlds: np.ndarray) -> None:
        super().__init__(len(worlds))
        self._worlds = worlds
        self._runs: dict[tuple[int, int], list[Callable[[], None]]] = {}
        self.run: Callable[[], None] = self._run

    def load(self, program: Program) -> None:  # noqa: D102
        self.program = program
        self._runs.clear()

    def _run(self) -> None:
        for first, count in consecutive(self._worlds[: self._world_count]):
            launches = self._runs.get((first, count))
            if launches is None:
                launches = [over(first, count) for over in self.program.detection]  # type: ignore[operator]
                if count == len(self._worlds):
                    self._runs[first, count] = launches
            _perform(launches)


def consecutive(numbers: np.ndarray) -> list[tuple[int, int]]:
    """Runs of consecutive numbers: first number and length of each."""
    runs = np.split(numbers, np.flatnonzero(np.diff(numbers) != 1) + 1)
    return [(int(run[0]), len(run)) for run in runs if len(run)]


def _perform(launches: Sequence[Callable[[], None]]) -> None:
    for launch in launches:
        launch()


def _nothing() -> None:
    """Do nothing: no program has been loaded yet."""
