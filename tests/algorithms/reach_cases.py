"""What inverse kinematics is asked for the comparison with PyBullet: runs with either module."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
ASSETS = ROOT / "src" / "pybullet_data"
ROBOTS = ROOT / "tests" / "conformance" / "robots"
CLOSE = 1e-3
"""A target counts as reached at this distance [m] and angle [rad]."""


@dataclass(frozen=True)
class Arm:
    """A robot, the link that is to reach, where it starts from; whether PyBullet's search is slow there."""

    file: Path
    link: int
    home: tuple[float, ...]
    fixed_base: bool = True
    slow: bool = False


ARMS = {
    "panda": Arm(
        ASSETS / "franka_panda" / "panda.urdf", 11, (0.0, -0.4, 0.0, -2.0, 0.0, 1.6, 0.8, 0.02, 0.02)
    ),
    "kuka": Arm(ASSETS / "kuka_iiwa" / "model.urdf", 6, (0.0, 0.5, 0.0, -1.5, 0.0, 1.0, 0.0)),
    "xarm": Arm(ASSETS / "xarm" / "xarm6_robot.urdf", 6, (0.0, -0.3, -1.2, 0.0, 1.0, 0.0), slow=True),
    "a1": Arm(ASSETS / "a1" / "a1.urdf", 5, 4 * (0.0, 0.8, -1.6), slow=True),
    "seven_dof": Arm(ROBOTS / "seven_dof.urdf", 7, (0.1, 0.5, 0.0, -1.2, 0.1, 1.0, 0.2)),
    "tree": Arm(ROBOTS / "tree.urdf", 1, (), fixed_base=False),
}


@dataclass(frozen=True)
class Way:
    """One way of asking, and for how many random poses."""

    poses: int
    oriented: bool = False
    limited: bool = False
    options: dict[str, Any] = field(default_factory=dict)


_PATIENT = {"maxNumIterations": 1000, "residualThreshold": 1e-5}
WAYS = {
    "default": Way(1000),
    "100 iterations": Way(1000, options={"maxNumIterations": 100, "residualThreshold": 1e-5}),
    "1000 iterations": Way(1000, options=_PATIENT),
    "oriented": Way(1000, oriented=True, options={"maxNumIterations": 20}),
    "oriented, 1000 iterations": Way(1000, oriented=True, options=_PATIENT),
    "limits and rest poses": Way(1000, limited=True, options=_PATIENT),
    "limits and rest poses, oriented": Way(1000, oriented=True, limited=True, options=_PATIENT),
}
ANSWERS_KEPT = 15
"""So many answers of PyBullet are kept to compare with, beside the number of targets reached."""


class Reach:
    """A robot in a world, and targets that it can reach.

    Args:
        pybullet: The module to ask.
        arm: The robot.
    """

    def __init__(self, pybullet: Any, arm: Arm) -> None:
        self.p = pybullet
        self.client = pybullet.connect(pybullet.DIRECT)
        self.arm = arm
        self.body = pybullet.loadURDF(
            str(arm.file),
            [0.2, -0.1, 0.3],
            [0.1, 0.2, 0.3, 0.9],
            useFixedBase=arm.fixed_base,
            physicsClientId=self.client,
        )
        infos = [
            pybullet.getJointInfo(self.body, index, physicsClientId=self.client)
            for index in range(pybullet.getNumJoints(self.body, physicsClientId=self.client))
        ]
        self.joints = [info[0] for info in infos if info[2] in (0, 1)]
        limits = np.array([info[8:10] for info in infos if info[2] in (0, 1)])
        unlimited = limits[:, 0] >= limits[:, 1]
        limits[unlimited] = (-np.pi, np.pi)
        self.lower, self.upper = limits.T
        self.home = np.array(arm.home or 0.5 * (self.lower + self.upper))

    def place(self, positions: Any) -> tuple[np.ndarray, np.ndarray]:
        """Position of the link frame and axes of the inertial frame, with the joints there."""
        for joint, position in zip(self.joints, positions, strict=True):
            self.p.resetJointState(self.body, joint, position, physicsClientId=self.client)
        state = self.p.getLinkState(self.body, self.arm.link, physicsClientId=self.client)
        return np.array(state[4]), np.array(state[1])

    def targets(self, count: int) -> list[tuple[np.ndarray, np.ndarray]]:
        """Where the link is at random joint positions within the limits."""
        random = np.random.RandomState(7)
        return [self.place(random.uniform(self.lower, self.upper)) for _ in range(count)]

    def ask(self, way: Way, target: tuple[np.ndarray, np.ndarray]) -> tuple[float, ...]:
        """Joint positions for a target, from home."""
        for joint, position in zip(self.joints, self.home, strict=True):
            self.p.resetJointState(self.body, joint, position, physicsClientId=self.client)
        options = dict(way.options)
        if way.limited:
            options |= {
                "lowerLimits": self.lower.tolist(),
                "upperLimits": self.upper.tolist(),
                "jointRanges": (self.upper - self.lower).tolist(),
                "restPoses": self.home.tolist(),
            }
        if way.oriented:
            options["targetOrientation"] = target[1].tolist()
        return self.p.calculateInverseKinematics(
            self.body, self.arm.link, target[0].tolist(), physicsClientId=self.client, **options
        )

    def distances(self, target: tuple[np.ndarray, np.ndarray], positions: Any) -> tuple[float, float]:
        """Distance [m] and angle [rad] between a target and where joint positions take the link."""
        position, orientation = self.place(positions)
        cosine = min(1.0, abs(float(orientation @ target[1])))
        return float(np.linalg.norm(position - target[0])), 2.0 * float(np.arccos(cosine))

    def reached(self, way: Way, target: tuple[np.ndarray, np.ndarray], positions: Any) -> bool:
        """The joint positions do what was asked, limits left aside."""
        distance, angle = self.distances(target, positions)
        return distance <= CLOSE and (angle <= CLOSE or not way.oriented)

    def within_limits(self, positions: Any) -> bool:
        """Every joint is in its range."""
        return bool(np.all(positions >= self.lower - 1e-9) and np.all(positions <= self.upper + 1e-9))

    def close(self) -> None:
        """Give the world back."""
        self.p.disconnect(self.client)


def single_calls(reach: Reach) -> dict[str, dict[str, Any]]:
    """Calls with one argument each out of the ordinary, by name: arguments after the body."""
    few, many = {"maxNumIterations": 3}, {"maxNumIterations": 500, "residualThreshold": 1e-9}
    freedoms = len(reach.joints)
    link = reach.arm.link
    position, orientation = (values.tolist() for values in reach.targets(3)[2])
    one = {"endEffectorLinkIndex": link, "targetPosition": position}
    near = [0.9 * q for q in reach.home.tolist()]
    base = reach.p.getBasePositionAndOrientation(reach.body, physicsClientId=reach.client)
    from_base, _ = reach.p.multiplyTransforms(*reach.p.invertTransform(*base), position, [0, 0, 0, 1])
    return {
        "three iterations": one | few,
        "loose threshold": one | {"residualThreshold": 0.05, "maxNumIterations": 200},
        "damping": one | many | {"jointDamping": [0.1 + 0.2 * (k % 3) for k in range(freedoms)]},
        "light damping": one | many | {"jointDamping": [1e-3] * freedoms},
        "too little damping given": one | many | {"jointDamping": [0.1]},
        "current positions": one | many | {"currentPositions": near, "targetPosition": list(from_base)},
        "orientation not of unit length": one
        | {
            "targetOrientation": [2.0 * component for component in orientation],
            "jointDamping": [1e-2] * freedoms,
        }
        | many,
        "limits without the rest": one
        | many
        | {"lowerLimits": [-9.0] * freedoms, "upperLimits": [9.0] * freedoms},
        "base": {"endEffectorLinkIndex": -1, "targetPosition": position},
    }


def two_ends(reach: Reach) -> dict[str, Any]:
    """A call with two ends: the link that reaches, and another on the way to it or in another branch."""
    other = reach.arm.link // 2 if reach.arm.fixed_base else reach.arm.link + 2
    ends = [reach.arm.link, other]
    reach.place(0.9 * reach.home + 0.1)
    positions = [reach.p.getLinkState(reach.body, link, physicsClientId=reach.client)[4] for link in ends]
    return {
        "endEffectorLinkIndices": ends,
        "targetPositions": [list(position) for position in positions],
        "maxNumIterations": 1000,
        "residualThreshold": 5e-3,
    }
