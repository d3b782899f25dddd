"""Where the time of a step goes: the same step in more launches, each of them timed."""

from __future__ import annotations

import time
from types import TracebackType

from carom.collision.stages import broad_phase_kernel, narrow_phase_kernel
from carom.engine.engine import Engine
from carom.engine.interpreter import ALL_SUBSTEPS, Stepper
from carom.engine.program import Plan, Program, step_program
from carom.model.launch import KernelStructs, Launch
from carom.model.status import STATUS, WELL
from carom.physics.kinematics import link_poses_kernel
from carom.physics.stages import constraints_kernel, free_motion_kernel, islands_kernel, motion_kernel

# Stages by the kernels that are launched for them.
_DETECTION = {
    "link poses": link_poses_kernel,
    "broad phase": broad_phase_kernel,
    "narrow phase": narrow_phase_kernel,
}
_MOTION = {
    "islands": islands_kernel,
    "free motion": free_motion_kernel,
    "constraints": constraints_kernel,
    "integration": motion_kernel,
}
STAGES = (*_DETECTION, *_MOTION)
_STAGE_OF = {kernel: stage for stage, kernel in (*_DETECTION.items(), *_MOTION.items())}


class StagedStepper(Stepper):
    """Performs programs on the only world there is, as an `Interpreter` does, and times their stages.

    Attributes:
        seconds: What each stage has taken.
        run: Performs what has been asked for.
    """

    def __init__(self, engine: Engine) -> None:
        self._engine = engine
        self._asked: dict[str, int] = {"first_substep": 0, "end_substep": ALL_SUBSTEPS}
        self.seconds: dict[str, float] = dict.fromkeys(STAGES, 0.0)
        self.run = self._run

    def load(self, program: Program) -> None:
        """Perform another program from now on."""
        self.program = program

    def ask(self, **asked: int) -> None:
        """Set scalars as those of `Interpreter`."""
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
                self.seconds[stage] += time.perf_counter() - start
            if self._engine.status[0, STATUS] != WELL:
                return False
        return True


class Profile:
    """A context in which an engine's steps are cut into stages.

    Attributes:
        seconds: What each stage has taken.
    """

    def __init__(self, engine: Engine) -> None:
        self._engine = engine
        self._stepper = StagedStepper(engine)
        self.seconds = self._stepper.seconds

    def __enter__(self) -> Profile:
        self._engine.step_by(staged_program, [self._stepper])
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, traceback: TracebackType | None
    ) -> None:
        self._engine.step_by(step_program)


def staged_program(structs: KernelStructs, device: str, plan: Plan) -> Program:
    """The launches of a step as `step_program` gives them, in stages."""
    program = step_program(structs, device, plan._replace(coupled=True))
    detection = [structs.launch(kernel, device, first_world=0) for kernel in _DETECTION.values()]
    stages = [structs.launch(kernel, device, first_world=0) for kernel in _MOTION.values()]
    motion = [*program.motion[:-2], *stages, program.motion[-1]] if plan.sleeping else stages
    return program._replace(detection=detection if plan.touching else [], motion=motion)
