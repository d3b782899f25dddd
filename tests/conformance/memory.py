"""Long work whose memory must not grow, and how memory is measured."""

from __future__ import annotations

import gc
import tracemalloc
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from .scenario import load, load_asset, movable_joints

_STATUS = Path("/proc/self/statm")
_PAGE = 4096


@dataclass(frozen=True)
class Growth:
    """How much more memory the second half of a long work holds than the first left behind.

    Attributes:
        resident: Bytes of the process; None where the system does not tell.
        python: Bytes in Python objects.
    """

    resident: int | None
    python: int


def resident_bytes() -> int | None:
    """Memory the process holds, where the system tells."""
    return int(_STATUS.read_text().split()[1]) * _PAGE if _STATUS.exists() else None


def growth_of(work: Callable[[int], None], count: int) -> Growth:
    """Do `work(count / 2)` twice; the first half may fill caches, the second must not add to them."""
    tracemalloc.start()
    try:
        work(count // 2)
        gc.collect()
        resident, python = resident_bytes(), tracemalloc.get_traced_memory()[0]
        work(count - count // 2)
        gc.collect()
        later = resident_bytes()
        return Growth(
            None if resident is None or later is None else later - resident,
            tracemalloc.get_traced_memory()[0] - python,
        )
    finally:
        tracemalloc.stop()


def stepping(p: Any) -> Callable[[int], None]:
    """A world with two robots under motors; the work is to step, command and read it."""
    p.setGravity(0, 0, -9.81)
    bodies = [
        load(p, "seven_dof.urdf", useFixedBase=True),
        load(p, "tree.urdf", basePosition=[5, 0, 0], useFixedBase=True),
    ]
    joints = {body: movable_joints(p, body) for body in bodies}

    def work(steps: int) -> None:
        for step in range(steps):
            if step % 16 == 0:
                for body in bodies:
                    targets = [0.2 * ((step // 16) % 3 - 1)] * len(joints[body])
                    p.setJointMotorControlArray(
                        body, joints[body], p.POSITION_CONTROL, targetPositions=targets
                    )
                    p.getJointStates(body, joints[body])
                    p.getLinkState(body, 0, computeLinkVelocity=1)
                p.applyExternalForce(bodies[0], 3, [1, 0, 0], [0, 0, 0], p.LINK_FRAME)
            p.stepSimulation()

    return work


def loading(p: Any) -> Callable[[int], None]:
    """The work is to load a robot beside another one, step, and remove it again."""
    p.setGravity(0, 0, -9.81)
    load(p, "slider.urdf", useFixedBase=True)

    def work(cycles: int) -> None:
        for cycle in range(cycles):
            if cycle % 3 == 0:
                body = load_asset(p, "franka_panda/panda.urdf", basePosition=[9, 0, 0])
            else:
                body = load(p, ("hand.urdf", "arm_on_world.urdf")[cycle % 2], basePosition=[9, 0, 0])
            p.stepSimulation()
            p.removeBody(body)

    return work
