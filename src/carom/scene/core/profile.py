"""Profile of a step: the time that each stage takes, measured launch by launch."""

from __future__ import annotations

import time
from typing import Any

from carom.engine.engine import Engine
from carom.engine.interpreter import ALL_SUBSTEPS, Stepper
from carom.engine.program import DETECTION, MOTION, SOFT_MOTION, Plan, Program, step_program
from carom.layouts.status import STATUS, WELL
from carom.native.kernels import (
    begin_stages_kernel,
    converged_constraints_kernel,
    explicit_motion_kernel,
    implicit_integration_kernel,
    midpoint_integration_kernel,
    midpoint_motion_kernel,
    rk4_stage_kernel,
)
from carom.native.launch import KernelStructs, Launch

STAGES = (
    "link poses",
    "broad phase",
    "narrow phase",
    "islands",
    "free motion",
    "constraints",
    "integration",
)
SOFT_STAGE = "soft bodies"
"""Additional stage of worlds with soft bodies."""
_STAGE_OF = {
    **dict.fromkeys(SOFT_MOTION, SOFT_STAGE),
    **dict(zip((*DETECTION, *MOTION), STAGES, strict=True)),
    converged_constraints_kernel: STAGES[-2],
    **dict.fromkeys((explicit_motion_kernel, midpoint_motion_kernel), STAGES[-3]),
    **dict.fromkeys(
        (
            begin_stages_kernel,
            implicit_integration_kernel,
            midpoint_integration_kernel,
            rk4_stage_kernel,
        ),
        STAGES[-1],
    ),
}


class StagedStepper(Stepper):
    """Performs programs on a single world, as an `Interpreter` does, and times their stages [s]."""

    def __init__(self, engine: Engine) -> None:
        self._engine = engine
        self._asked: dict[str, Any] = {"first_substep": 0, "end_substep": ALL_SUBSTEPS}
        self.seconds: dict[str, float] = dict.fromkeys(STAGES, 0.0)
        self.run = self._run

    def load(self, program: Program) -> None:
        """Use another program from now on."""
        self.program = program

    def ask(self, **asked: Any) -> None:
        """Set numbers for all later runs, as `Interpreter.ask` does."""
        self._asked.update(asked)

    def _run(self) -> None:
        program, due = self.program, self._engine.due[0]
        rounds = max(1, due)
        first, end = self._asked["first_substep"], self._asked["end_substep"]
        well = first > 0 or self._perform(program.begin)
        for _ in range(first, min(end, rounds)):
            well = well and self._perform(program.detection) and (due == 0 or self._perform(program.motion))
        if well and end >= rounds:
            well = self._perform(program.end)
        if not well:
            for launch in program.abandon:
                launch()

    def _perform(self, launches: list[Launch]) -> bool:
        for launch in launches:
            start = time.perf_counter()
            launch()
            stage = _STAGE_OF.get(launch.kernel)
            if stage is not None:
                taken = time.perf_counter() - start
                self.seconds[stage] = self.seconds.get(stage, 0.0) + taken
            if self._engine.status[0, STATUS] != WELL:
                return False
        return True


class Profile:
    """A context in which the steps of an engine are split into stages and timed [s]."""

    def __init__(self, engine: Engine) -> None:
        self._engine = engine
        self._stepper = StagedStepper(engine)
        self.seconds = self._stepper.seconds

    def __enter__(self) -> Profile:
        self._engine.step_by(staged_program, [self._stepper])
        return self

    def __exit__(self, *_: object) -> None:
        self._engine.step_by(step_program)


def staged_program(structs: KernelStructs, plan: Plan) -> Program:
    """The program of `step_program`, in separate stages even if bodies cannot interact."""
    return step_program(structs, plan._replace(coupled=True))
