"""Which kernels a step consists of, and in which order they run."""

from __future__ import annotations

from typing import NamedTuple

from carom.collision.collide import collide_kernel
from carom.model.launch import KernelStructs, Launch
from carom.physics.coupled_step import coupled_step_kernel
from carom.physics.kinematics import link_poses_kernel
from carom.physics.slumber import settle_kernel, watch_kernel
from carom.physics.step import step_kernel
from carom.physics.step_ends import abandon_step_kernel, begin_step_kernel, end_step_kernel


class Plan(NamedTuple):
    """What a step has to look for.

    Attributes:
        touching: Some shapes could touch.
        sleeping: Some body could fall asleep, or is asleep.
        coupled: Something could tie bodies together: they touch, or users have tied them.
    """

    touching: bool
    sleeping: bool
    coupled: bool


class Program(NamedTuple):
    """The launches of a step of one world, in the order in which they run.

    Attributes:
        begin: At its beginning; all of a step of bodies that have nothing to do with each other.
        detection: In each substep: collision detection.
        motion: After that.
        end: At its end.
        abandon: In place of all that is left, as soon as the world's status is no longer `WELL`.
    """

    begin: list[Launch]
    detection: list[Launch]
    motion: list[Launch]
    end: list[Launch]
    abandon: list[Launch]

    @property
    def whole(self) -> Launch | None:
        """The one launch that a step of one substep consists of, if it does."""
        return None if self.detection or self.motion or self.end else self.begin[0]


def step_program(structs: KernelStructs, device: str, plan: Plan) -> Program:
    """The launches of a step over the arrays of a workspace."""
    abandon = [_launch(structs, device, abandon_step_kernel)]
    if not plan.coupled:
        whole = _launch(structs, device, step_kernel, substeps=1)
        return Program(begin=[whole], detection=[], motion=[], end=[], abandon=abandon)
    detection = [_launch(structs, device, kernel) for kernel in (link_poses_kernel, collide_kernel)]
    motion = [_launch(structs, device, coupled_step_kernel)]
    if plan.sleeping:
        settle = _launch(structs, device, settle_kernel, touching=int(plan.touching))
        motion = [settle, *motion, _launch(structs, device, watch_kernel)]
    return Program(
        begin=[_launch(structs, device, begin_step_kernel, moves=1)],
        detection=detection if plan.touching else [],
        motion=motion,
        end=[_launch(structs, device, end_step_kernel)],
        abandon=abandon,
    )


def detection_program(structs: KernelStructs, device: str) -> Program:
    """The launches that find all contacts for the present coordinates."""
    return Program(
        begin=[_launch(structs, device, begin_step_kernel, moves=0)],
        detection=[_launch(structs, device, kernel) for kernel in (link_poses_kernel, collide_kernel)],
        motion=[],
        end=[],
        abandon=[_launch(structs, device, abandon_step_kernel)],
    )


def _launch(structs: KernelStructs, device: str, kernel: object, **scalars: int) -> Launch:
    return structs.launch(kernel, device, first_world=0, **scalars)
