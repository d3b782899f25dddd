"""Robots of MJCF files, by the names of their links and joints, and the worlds they move in."""

from __future__ import annotations

import os
from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import Any

import gymnasium
import numpy as np

import pybullet
import pybullet_data
from pybullet_envs.env_bases import BulletEnv

_LOADING = (
    pybullet.URDF_USE_SELF_COLLISION
    | pybullet.URDF_USE_SELF_COLLISION_EXCLUDE_ALL_PARENTS
    | pybullet.URDF_GOOGLEY_UNDEFINED_COLORS
)
_SOLVER_ITERATIONS = 5
_CONTACT_ERP = 0.9


@dataclass(frozen=True)
class Part:
    """A link; -1 is the base."""

    bullet: Any
    body: int
    link: int

    def pose(self) -> tuple[np.ndarray, np.ndarray]:
        """Position [m] of the centre of mass, and orientation (x, y, z, w)."""
        if self.link < 0:
            position, orientation = self.bullet.getBasePositionAndOrientation(self.body)
        else:
            position, orientation = self.bullet.getLinkState(self.body, self.link)[:2]
        return np.array(position), np.array(orientation)

    def velocity(self) -> np.ndarray:
        """Velocity [m/s] of the centre of mass."""
        if self.link < 0:
            return np.array(self.bullet.getBaseVelocity(self.body)[0])
        return np.array(self.bullet.getLinkState(self.body, self.link, computeLinkVelocity=1)[6])

    def touches(self, others: set[tuple[int, int]]) -> bool:
        """Whether it has contact with one of the links, given as (body, link)."""
        contacts = self.bullet.getContactPoints(self.body, -1, self.link, -1)
        return any((contact[2], contact[4]) in others for contact in contacts)


@dataclass(frozen=True)
class Motor:
    """A joint that is driven by a torque."""

    bullet: Any
    body: int
    joint: int
    lower: float
    upper: float

    def state(self) -> tuple[float, float]:
        """Position [rad or m] and velocity."""
        return self.bullet.getJointState(self.body, self.joint)[:2]

    def relative_state(self) -> tuple[float, float]:
        """Position from -1 at the lower limit to 1 at the upper one, and a tenth of the velocity."""
        position, velocity = self.state()
        middle = 0.5 * (self.lower + self.upper)
        return 2.0 * (position - middle) / (self.upper - self.lower), 0.1 * velocity

    def place(self, position: float) -> None:
        """Puts the joint somewhere at rest, without a motor."""
        self.bullet.resetJointState(self.body, self.joint, position, 0.0)
        self.release()

    def release(self) -> None:
        """Switches off the motor that joints have when they are loaded."""
        self.bullet.setJointMotorControl2(
            self.body, self.joint, pybullet.POSITION_CONTROL, positionGain=0.1, velocityGain=0.1, force=0
        )

    def drive(self, torque: float) -> None:
        """Applies a torque [N m] or force [N] in the next step."""
        self.bullet.setJointMotorControl2(self.body, self.joint, pybullet.TORQUE_CONTROL, force=float(torque))


class Parts:
    """Links and motors of some bodies, by name.

    Attributes:
        links: By name, in order.
        motors: By name, in order. Joints whose names begin with `ignore` are free and not among them.
    """

    def __init__(self, bullet: Any, robot_name: str) -> None:
        self._bullet = bullet
        self._robot_name = robot_name
        self.links: dict[str, Part] = {}
        self.motors: dict[str, Motor] = {}

    @property
    def body(self) -> Part:
        """The link that stands for the robot."""
        return self.links[self._robot_name]

    def add(self, bodies: tuple[int, ...]) -> None:
        """Takes the links and joints of more bodies."""
        for body in bodies:
            base_name = self._bullet.getBodyInfo(body)[0].decode()
            joints = [self._bullet.getJointInfo(body, j) for j in range(self._bullet.getNumJoints(body))]
            if not joints:
                self.links[base_name] = Part(self._bullet, body, -1)
            elif not self.links and joints[0][12].decode() != self._robot_name:
                self.links[self._robot_name] = Part(self._bullet, body, -1)
            for info in joints:
                self._add_joint(body, info)

    def _add_joint(self, body: int, info: Any) -> None:
        self.links[info[12].decode()] = Part(self._bullet, body, info[0])
        name = info[1].decode()
        motor = Motor(self._bullet, body, info[0], info[8], info[9])
        motor.release()
        if not name.startswith(("ignore", "jointfix")):
            self.motors[name] = motor


class MJCFEnv(BulletEnv, ABC):
    """An environment with one robot of an MJCF file.

    Attributes:
        model: The file.
        robot_name: The link that stands for the robot.
        gravity: Downwards [m/s²].
        time_step: Of the simulation [s].
        frame_skip: Steps of the simulation in a step of the environment.
        observation_count: Numbers of an observation.
        action_count: Numbers of an action, each from -1 to 1.
    """

    model: str
    robot_name: str
    gravity = 9.8
    time_step = 0.0165
    frame_skip = 1
    observation_count: int
    action_count: int

    def __init__(self, render: bool = False, render_mode: str | None = None) -> None:
        super().__init__(render, render_mode)
        endless = np.full(self.observation_count, np.inf, np.float32)
        ones = np.ones(self.action_count, np.float32)
        self.observation_space = gymnasium.spaces.Box(-endless, endless, dtype=np.float32)
        self.action_space = gymnasium.spaces.Box(-ones, ones, dtype=np.float32)
        self._start: int | None = None

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[np.ndarray, dict[str, Any]]:
        """Begins an episode."""
        super().reset(seed=seed)
        if self._connect():
            self._load()
            self._start = self._p.saveState()
        else:
            self._p.restoreState(self._start)
        self._place()
        return self._observe(), {}

    def close(self) -> None:
        """Ends the world; the next `reset` makes a new one."""
        super().close()
        self._start = None

    @property
    def frame_time(self) -> float:
        """Time that a step of the environment takes [s]."""
        return self.time_step * self.frame_skip

    def _load(self) -> None:
        """Builds the world."""
        bullet = self._p
        bullet.setPhysicsEngineParameter(deterministicOverlappingPairs=1)
        bullet.setGravity(0, 0, -self.gravity)
        bullet.setDefaultContactERP(_CONTACT_ERP)
        bullet.setPhysicsEngineParameter(
            fixedTimeStep=self.frame_time, numSolverIterations=_SOLVER_ITERATIONS, numSubSteps=self.frame_skip
        )
        file = os.path.join(pybullet_data.getDataPath(), "mjcf", self.model)
        self.parts = Parts(bullet, self.robot_name)
        self.parts.add(bullet.loadMJCF(file, flags=_LOADING))

    @abstractmethod
    def _place(self) -> None:
        """Puts the robot where an episode begins."""

    @abstractmethod
    def _observe(self) -> np.ndarray:
        """What the agent sees."""
