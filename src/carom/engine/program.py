"""The kernels of a step, their order, and how native code reads them."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import accumulate, chain
from typing import NamedTuple

from carom.engine.integrators import INTEGRATING, staged_motion
from carom.engine.parameters import DISCRETE, EXPLICIT, OF_STEPS
from carom.layouts.programs import KernelCall, WorldCall
from carom.layouts.programs import Program as ProgramRecord
from carom.native.kernels import (
    Kernel,
    abandon_adhesion_kernel,
    abandon_late_kernel,
    abandon_soft_kernel,
    abandon_step_kernel,
    adhesion_kernel,
    begin_adhesion_kernel,
    begin_late_kernel,
    begin_soft_kernel,
    begin_step_kernel,
    broad_phase_kernel,
    carry_nodes_kernel,
    constraints_kernel,
    continued_motion_kernel,
    converged_constraints_kernel,
    end_soft_kernel,
    end_step_kernel,
    free_motion_kernel,
    integration_kernel,
    inverse_constraints_kernel,
    islands_kernel,
    keep_velocities_kernel,
    lane_poses_kernel,
    lane_rows_kernel,
    late_free_motion_kernel,
    late_integration_kernel,
    link_poses_kernel,
    narrow_phase_kernel,
    settle_kernel,
    soft_motion_kernel,
    step_kernel,
    watch_kernel,
)
from carom.native.launch import KernelStructs, Launch

# Stages of a substep, in this order.
DETECTION = (link_poses_kernel, broad_phase_kernel, narrow_phase_kernel)
MOTION = (islands_kernel, free_motion_kernel, constraints_kernel, integration_kernel)
# The same of worlds whose free motion is computed several at once, without what solves their rows; and where
# these are relaxed several at once.
_LANE_MOTION = (islands_kernel, continued_motion_kernel, integration_kernel)
_RELAXED_LANE_MOTION = (islands_kernel, continued_motion_kernel, lane_rows_kernel, integration_kernel)
# The same for velocities after the substep that are given, see `kernels.newton.inverse`.
_INVERSE_MOTION = (islands_kernel, free_motion_kernel, inverse_constraints_kernel, integration_kernel)
# The same with soft bodies.
SOFT_MOTION = (
    keep_velocities_kernel,
    islands_kernel,
    free_motion_kernel,
    soft_motion_kernel,
    constraints_kernel,
    integration_kernel,
    # After integration, which also moves fixed bases by their velocities.
    carry_nodes_kernel,
)
# Those that advance velocities, before which all forces have to be known.
_MOVING = (free_motion_kernel, late_free_motion_kernel)
# What takes the place of others where constraints are solved until they converge.
_CONVERGED = {constraints_kernel: converged_constraints_kernel}
# And where links have late velocities.
_LATE = {free_motion_kernel: late_free_motion_kernel, integration_kernel: late_integration_kernel}


class Plan(NamedTuple):
    """Conditions that determine the parts of a step.

    Attributes:
        touching: Some shapes could touch.
        sleeping: Some body could fall asleep, or is asleep.
        coupled: A step needs its separate stages: bodies could interact or sleep, some are absent, there are
            soft bodies, links have late velocities or are adhesive, or a function is called after every
            substep.
        soft: There are soft bodies.
        absent: A body is absent in some world.
        converged: Constraints are solved until they converge.
        compliant: They are, and contacts of files that state MuJoCo's law follow that.
        noslip: Number of passes after which friction of these does not yield.
        late: Links of some body have late velocities, see `kernels.late`.
        adhesive: Some actuator pulls a link towards what touches it, see `kernels.adhesion`.
        integrator: As in `EngineParameters`.
    """

    touching: bool
    sleeping: bool
    coupled: bool
    soft: bool = False
    absent: bool = False
    converged: bool = False
    compliant: bool = False
    noslip: int = 0
    late: bool = False
    integrator: str = DISCRETE
    adhesive: bool = False


class Program(NamedTuple):
    """The launches of a step of one world, in the order in which they run.

    Attributes:
        begin: At the beginning of the step; for bodies that cannot interact, the whole step.
        detection: Collision detection, in each substep.
        motion: After collision detection, in each substep.
        end: At the end of the step.
        abandon: Run in place of all remaining launches, as soon as the world's status is not `WELL`.
    """

    begin: list[Launch]
    detection: list[Launch]
    motion: list[Launch]
    end: list[Launch]
    abandon: list[Launch]


def step_program(structs: KernelStructs, plan: Plan) -> Program:
    """The launches of a step over the arrays of a workspace."""
    kernels = SOFT_MOTION if plan.soft else MOTION
    if plan.converged:
        kernels = [_CONVERGED.get(kernel, kernel) for kernel in kernels]
    return _step_program(structs, plan, kernels)


def inverse_program(structs: KernelStructs, plan: Plan) -> Program:
    """Those of a step that finds the forces for given velocities after it; the plan is a converged one."""
    if plan.integrator in OF_STEPS:
        return _step_program(structs, plan._replace(integrator=DISCRETE), _INVERSE_MOTION)
    # Forces at an instant: what ends a step of these integrators has no part in it.
    return _step_program(structs, plan._replace(integrator=EXPLICIT), _INVERSE_MOTION)


def _step_program(structs: KernelStructs, plan: Plan, kernels: Sequence[Kernel]) -> Program:
    """The same with these kernels for the motion of worlds whose bodies can interact."""
    abandon = [_launch(structs, abandon_step_kernel)]
    if not plan.coupled:
        whole = _launch(structs, step_kernel, substeps=1)
        return Program(begin=[whole], detection=[], motion=[], end=[], abandon=abandon)
    if plan.late:
        kernels = [_LATE.get(kernel, kernel) for kernel in kernels]
    if plan.adhesive:
        moving = next(place for place, kernel in enumerate(kernels) if kernel in _MOVING)
        kernels = [*kernels[:moving], adhesion_kernel, *kernels[moving:]]
    detection = _detection(structs) if plan.touching else []
    if plan.integrator == DISCRETE:
        motion = [_motion_launch(structs, kernel, plan) for kernel in kernels]
    else:
        solving = kernels[kernels.index(integration_kernel) - 1]
        scalars = _scalars_of(solving, plan)
        motion = staged_motion(
            structs, plan.integrator, kernels, detection, by_frame=plan.compliant, **scalars
        )
    if plan.sleeping:
        settle = _launch(structs, settle_kernel, touching=int(plan.touching))
        motion = [settle, *motion, _launch(structs, watch_kernel)]
    begin, end = [_launch(structs, begin_step_kernel, moves=1)], [_launch(structs, end_step_kernel)]
    if plan.soft:
        begin.append(_launch(structs, begin_soft_kernel))
        end.append(_launch(structs, end_soft_kernel))
        abandon.append(_launch(structs, abandon_soft_kernel))
    if plan.late:
        begin.append(_launch(structs, begin_late_kernel))
        abandon.append(_launch(structs, abandon_late_kernel))
    if plan.adhesive:
        begin.append(_launch(structs, begin_adhesion_kernel))
        abandon.append(_launch(structs, abandon_adhesion_kernel))
    return Program(begin=begin, detection=detection, motion=motion, end=end, abandon=abandon)


def _motion_launch(structs: KernelStructs, kernel: Kernel, plan: Plan) -> Launch:
    return _launch(structs, kernel, **_scalars_of(kernel, plan))


def _scalars_of(kernel: Kernel, plan: Plan) -> dict[str, int]:
    """The arguments of a kernel of constraints that are numbers."""
    if kernel is converged_constraints_kernel:
        return {"compliant": int(plan.compliant), "noslip": plan.noslip}
    return {"compliant": int(plan.compliant)} if kernel is inverse_constraints_kernel else {}


def lane_program(structs: KernelStructs, plan: Plan) -> tuple[Program, int, Launch]:
    """The launches of a world that takes its step together with others, without those that solve its rows.

    Returns:
        The launches; the number of those before rows are solved; the launch that solves those of one world.
    """
    program = _step_program(structs, plan, _LANE_MOTION if plan.converged else _RELAXED_LANE_MOTION)
    if program.detection:
        _poses, *detection = program.detection
        program = program._replace(detection=[_launch(structs, lane_poses_kernel), *detection])
    end = next(place for place, launch in enumerate(program.motion) if launch.kernel in INTEGRATING)
    solve = converged_constraints_kernel if plan.converged else constraints_kernel
    return program, len(program.begin) + len(program.detection) + end, _motion_launch(structs, solve, plan)


def detection_program(structs: KernelStructs) -> Program:
    """The launches that find all contacts at the current coordinates."""
    return Program(
        begin=[_launch(structs, begin_step_kernel, moves=0)],
        detection=_detection(structs),
        motion=[],
        end=[],
        abandon=[_launch(structs, abandon_step_kernel)],
    )


def _detection(structs: KernelStructs) -> list[Launch]:
    return [_launch(structs, kernel) for kernel in DETECTION]


def _launch(structs: KernelStructs, kernel: Kernel, **scalars: int) -> Launch:
    return structs.launch(kernel, first_world=0, **scalars)


def write_program(record: ProgramRecord, program: Program) -> None:
    """Put the launches of a program into its record; both have to exist as long as the record is used."""
    record.part_ends[:] = list(accumulate(map(len, program)))
    for place, launch in enumerate(chain.from_iterable(program)):
        record.launches[place] = world_call(launch)


def world_call(launch: Launch) -> WorldCall:
    """A launch for one world; it has to exist as long as the record is used."""
    *call, first_world, substeps = launch.addresses("first_world", "substeps")
    return WorldCall(KernelCall(*call), first_world, substeps, None)
