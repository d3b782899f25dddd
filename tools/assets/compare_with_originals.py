"""Move our robots and the originals alike in real PyBullet, and print how far their joints end up apart.

Run with an interpreter that has PyBullet and the original pybullet_data:

    .oracle/bin/python tools/assets/compare_with_originals.py
"""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path

import pybullet as p
import pybullet_data

OURS = Path(__file__).resolve().parents[2] / "src" / "pybullet_data"
ORIGINALS = Path(pybullet_data.getDataPath())
STEPS = 480
"""Two seconds."""

ROBOTS = (
    "franka_panda/panda.urdf",
    "kuka_iiwa/model.urdf",
    "r2d2.urdf",
    "cartpole.urdf",
    "pendulum5.urdf",
    "TwoJointRobot_w_fixedJoints.urdf",
    "husky/husky.urdf",
    "racecar/racecar.urdf",
    "a1/a1.urdf",
    "laikago/laikago_toes.urdf",
    "mini_cheetah/mini_cheetah.urdf",
    "quadruped/minitaur.urdf",
    "xarm/xarm6_robot.urdf",
)
Drive = Callable[[int, list[int], int], None]


def hold(body: int, joints: list[int], step: int) -> None:
    """Nothing: the default motors brake the joints."""


def move(body: int, joints: list[int], step: int) -> None:
    """Position targets on a slow sine, different for every joint."""
    for rank, joint in enumerate(joints):
        lower, upper = p.getJointInfo(body, joint)[8:10]
        middle, swing = ((lower + upper) / 2, 0.3 * (upper - lower)) if lower < upper else (0.0, 0.5)
        target = middle + swing * math.sin(0.01 * step + rank)
        p.setJointMotorControl2(body, joint, p.POSITION_CONTROL, target, force=87.0)


def fall(body: int, joints: list[int], step: int) -> None:
    """Motors off."""
    if step == 0:
        for joint in joints:
            p.setJointMotorControl2(body, joint, p.VELOCITY_CONTROL, force=0.0)


def final_state(path: Path, drive: Drive, fixed: bool, flags: int) -> list[float]:
    """Joint positions after two seconds, and the base's position where it is free."""
    p.resetSimulation()
    p.setGravity(0.0, 0.0, -9.81)
    body = p.loadURDF(str(path), [0.0, 0.0, 5.0], useFixedBase=fixed, flags=flags)
    joints = [
        joint for joint in range(p.getNumJoints(body)) if p.getJointInfo(body, joint)[2] != p.JOINT_FIXED
    ]
    for rank, joint in enumerate(joints):
        lower, upper = p.getJointInfo(body, joint)[8:10]
        start = (lower + upper) / 2 + 0.1 * (upper - lower) if lower < upper else 0.3 - 0.1 * rank
        p.resetJointState(body, joint, start)
    for step in range(STEPS):
        drive(body, joints, step)
        p.stepSimulation()
    positions = [p.getJointState(body, joint)[0] for joint in joints]
    return positions if fixed else [*positions, *p.getBasePositionAndOrientation(body)[0]]


def main() -> None:
    p.connect(p.DIRECT)
    drives: tuple[Drive, ...] = (hold, move, fall)
    print("| robot | base | inertia | " + " | ".join(drive.__name__ for drive in drives) + " |")
    print("|---|---|---|" + "---|" * len(drives))
    for name in ROBOTS:
        for fixed in (True, False):
            for label, flags in (("from shapes", 0), ("from file", p.URDF_USE_INERTIA_FROM_FILE)):
                apart: list[str] = []
                for drive in drives:
                    ends = [final_state(root / name, drive, fixed, flags) for root in (ORIGINALS, OURS)]
                    apart.append(f"{max(abs(a - b) for a, b in zip(*ends, strict=True)):.1e}")
                base = "fixed" if fixed else "free"
                print(f"| {name} | {base} | {label} | " + " | ".join(apart) + " |")


if __name__ == "__main__":
    main()
