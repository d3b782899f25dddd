"""Where the time of a step goes: the same step in more launches, each of them timed."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Any

from carom.collision.stages import broad_phase_kernel, narrow_phase_kernel
from carom.model.launch import KernelStructs, Launch, argument_indices, launch
from carom.physics.stages import constraints_kernel, free_motion_kernel, islands_kernel, motion_kernel
from carom.stepper import BEGINS, ENDS, SUBSTEPS, Detection, Stepper
from carom.touch_arrays import TouchArrays

STAGES = (
    "link poses",
    "broad phase",
    "narrow phase",
    "islands",
    "free motion",
    "constraints",
    "integration",
)


class StageClock:
    """Seconds that each stage has taken."""

    def __init__(self) -> None:
        self.seconds: dict[str, float] = dict.fromkeys(STAGES, 0.0)

    def time(self, stage: str, run: Callable[[], None]) -> None:
        """Run something that belongs to a stage."""
        start = time.perf_counter()
        run()
        self.seconds[stage] += time.perf_counter() - start


class ProfiledDetection(Detection):
    """Collision detection, timed by stage."""

    def __init__(self, structs: KernelStructs, touch: TouchArrays, device: str, clock: StageClock) -> None:
        super().__init__(structs, touch, device)
        self._clock = clock
        self._broad_phase = launch(broad_phase_kernel, structs, device)
        self._narrow_phase = launch(narrow_phase_kernel, structs, device)

    def _detect(self) -> None:
        self._clock.time("link poses", self._poses)
        self._clock.time("broad phase", self._broad_phase)
        self._clock.time("narrow phase", self._narrow_phase)


class StagedStep:
    """The launches that make up that of a step; it is called and changed like one."""

    def __init__(self, structs: KernelStructs, device: str, clock: StageClock) -> None:
        self._clock = clock
        self._arguments = {SUBSTEPS: 1, BEGINS: 1, ENDS: 1}
        self._islands = launch(islands_kernel, structs, device, **{BEGINS: 1})
        self._free_motion = launch(free_motion_kernel, structs, device)
        self._constraints = launch(constraints_kernel, structs, device)
        self._motion = launch(motion_kernel, structs, device, **{ENDS: 1})

    def replace(self, name: str, value: int) -> None:
        """Change an argument for all later runs."""
        self._arguments[name] = value

    def __call__(self) -> None:
        """Run all stages of as many substeps as asked for."""
        count = max(1, self._arguments[SUBSTEPS])
        for substep in range(count):
            begins = self._arguments[BEGINS] if substep == 0 else 0
            ends = self._arguments[ENDS] if substep == count - 1 else 0
            self._run(self._islands, islands_kernel, BEGINS, begins, "islands")
            self._clock.time("free motion", self._free_motion)
            self._clock.time("constraints", self._constraints)
            self._run(self._motion, motion_kernel, ENDS, ends, "integration")

    def _run(self, stage: Launch, kernel: Any, flag: str, value: int, name: str) -> None:
        stage.replace(argument_indices(kernel)[flag], value)
        self._clock.time(name, stage)


class ProfiledStepper(Stepper):
    """Steps as `Stepper` does, timed by stage."""

    def __init__(
        self,
        structs: KernelStructs,
        touch: TouchArrays,
        fault: memoryview,
        substeps: int,
        device: str,
        *,
        touching: bool,
        sleeping: bool,
        watched: bool,
        clock: StageClock,
    ) -> None:
        super().__init__(
            structs,
            touch,
            fault,
            substeps,
            device,
            touching=touching,
            sleeping=sleeping,
            watched=watched,
        )
        self._once = None
        self._launch = StagedStep(structs, device, clock)
        self._index = {name: name for name in (SUBSTEPS, BEGINS, ENDS)}
        if touching:
            self.detection = ProfiledDetection(structs, touch, device, clock)

    @property
    def single(self) -> None:
        """No step is a single launch here."""
        return
