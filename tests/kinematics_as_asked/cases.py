"""Random questions of inverse kinematics with each combination of arguments: run with either module."""

from __future__ import annotations

import itertools
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
ASSETS = ROOT / "src" / "pybullet_data"
LONG_ARM = Path(__file__).with_name("long_arm.urdf")
NUDGE = 1e-13
"""Targets are moved by this [m], also orientations, to see whether PyBullet's answer hangs on rounding."""
UNSTEADY = 1e-10
"""It does if the nudge changes a joint by more [rad or m]."""


@dataclass(frozen=True)
class Robot:
    """A file below a folder of data, the ends to reach with, and whether the base is fixed."""

    file: str | Path
    ends: tuple[int, ...]
    fixed_base: bool = True


ROBOTS = {
    "panda": Robot("franka_panda/panda.urdf", (11, 5)),
    "kuka": Robot("kuka_iiwa/model.urdf", (6, 3)),
    "xarm": Robot("xarm/xarm6_robot.urdf", (6, 3)),
    "laikago": Robot("laikago/laikago.urdf", (2, 5, 8, 11), fixed_base=False),
    "r2d2": Robot("r2d2.urdf", (10, 13), fixed_base=False),
    # J Jᵀ has eigenvalues a hundred times the damping of null-space steps.
    "long arm": Robot(LONG_ARM, (5, 2)),
}
# Each may be given or not.
CHOICES = ("orientation", "rests", "damping", "current", "steps", "threshold")
COMBINATIONS = [
    "+".join(name for name, chosen in zip(CHOICES, chosen, strict=True) if chosen) or "position"
    for chosen in itertools.product((False, True), repeat=len(CHOICES))
]
SEVERAL = [f"2:{names}" for names in ("position", "damping", "current", "steps+threshold", "rests")]


class Asker:
    """A robot in a world of its own, and random questions about it.

    Args:
        pybullet: The module to ask.
        name: The robot.
        data: The folder of data.
    """

    def __init__(self, pybullet: Any, name: str, data: Path) -> None:
        self.p, self.robot = pybullet, ROBOTS[name]
        self.client = pybullet.connect(pybullet.DIRECT)
        self.body = pybullet.loadURDF(
            str(data / self.robot.file), useFixedBase=self.robot.fixed_base, physicsClientId=self.client
        )
        infos = [
            pybullet.getJointInfo(self.body, joint, physicsClientId=self.client)
            for joint in range(pybullet.getNumJoints(self.body, physicsClientId=self.client))
        ]
        self.joints = [info[0] for info in infos if info[2] != pybullet.JOINT_FIXED]
        limits = np.array([infos[joint][8:10] for joint in self.joints])
        limits[limits[:, 0] >= limits[:, 1]] = (-3.0, 3.0)
        self.lower, self.upper = limits.T

    def place(self, positions: np.ndarray) -> None:
        """Put the joints there."""
        for joint, position in zip(self.joints, positions.tolist(), strict=True):
            self.p.resetJointState(self.body, joint, position, physicsClientId=self.client)

    def answer(self, combination: str, seed: int, nudge: float = 0.0) -> list[float]:
        """What is answered to a random question, from a random pose; near or far away, in reach or not."""
        random = np.random.RandomState([seed, *combination.encode()])
        several, _, names = combination.rpartition(":")
        chosen = names.split("+")
        turn = random.normal(size=4)
        upright = random.rand() < 0.5
        base = random.uniform(-0.5, 0.5, 3), [0, 0, 0, 1] if upright else turn / np.linalg.norm(turn)
        self.p.resetBasePositionAndOrientation(
            self.body, *(list(values) for values in base), physicsClientId=self.client
        )
        start, goal = random.uniform(self.lower, self.upper, (2, len(self.lower)))
        goal = start + random.choice([0.02, 0.3, 1.0]) * (goal - start)
        self.place(goal)
        ends = self.robot.ends if several else self.robot.ends[:1]
        states = [
            self.p.getLinkState(self.body, end, computeForwardKinematics=1, physicsClientId=self.client)
            for end in ends
        ]
        self.place(start)
        far = random.choice([1.0, 1.0, 1.0, 3.0])
        targets = [(far * np.array(state[0]) + nudge).tolist() for state in states]
        options = self._options(random, chosen, start)
        if "orientation" in chosen:
            down = random.rand() < 0.3
            orientation = [1, 0, 0, 0] if down else states[0][1]
            options["targetOrientation"] = [component + nudge for component in orientation]
        ask = self.p.calculateInverseKinematics2 if several else self.p.calculateInverseKinematics
        where = (list(ends), targets) if several else (ends[0], targets[0])
        return list(ask(self.body, *where, physicsClientId=self.client, **options))

    def _options(self, random: np.random.RandomState, chosen: list[str], start: np.ndarray) -> dict[str, Any]:
        count, options = len(self.lower), {}
        spread = self.upper - self.lower
        if "rests" in chosen:
            # Half of the limits are narrow, so that joints are beyond them.
            narrow = random.choice([0.0, 0.4])
            options |= {
                "lowerLimits": (self.lower + narrow * spread).tolist(),
                "upperLimits": (self.upper - narrow * spread).tolist(),
                "jointRanges": spread.tolist(),
                "restPoses": random.uniform(self.lower, self.upper).tolist(),
            }
        if "damping" in chosen:
            options["jointDamping"] = (10.0 ** random.uniform(-3, 1, count)).tolist()
        if "current" in chosen:
            options["currentPositions"] = (start + random.normal(0, 0.1, count)).tolist()
        if "steps" in chosen:
            options["maxNumIterations"] = int(random.choice([1, 5, 20, 100]))
        if "threshold" in chosen:
            options["residualThreshold"] = float(random.choice([0.0, 1e-6, 1e-2]))
        return options

    def close(self) -> None:
        """Give the world back."""
        self.p.disconnect(self.client)


def small_steps(asker: Asker, count: int = 60, **options: Any) -> list[float]:
    """The positions after so many small steps of the first end's target, each from the answer before."""
    random, end = np.random.RandomState(5), asker.robot.ends[0]
    positions = 0.5 * (asker.lower + asker.upper) + 0.1
    asker.place(positions)
    state = asker.p.getLinkState(asker.body, end, computeForwardKinematics=1, physicsClientId=asker.client)
    # PyBullet rounds frames of links to single precision.
    target = np.round(state[4], 2)
    for _ in range(count):
        asker.place(positions)
        target = target + random.uniform(-0.02, 0.02, 3)
        found = asker.p.calculateInverseKinematics(
            asker.body, end, target.tolist(), physicsClientId=asker.client, **options
        )
        positions = np.array(found)
    return positions.tolist()
