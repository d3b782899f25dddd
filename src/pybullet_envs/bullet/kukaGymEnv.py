"""An environment with a KUKA that moves down to a tray, steered by actions, and grasps a block."""

from __future__ import annotations

import os
import time
from typing import Any

import numpy as np

from pybullet_envs._gymnasium import gymnasium
from pybullet_envs.bullet.kuka import Kuka
from pybullet_envs.bullet.urdf_env import RENDER_HEIGHT, RENDER_WIDTH, UrdfEnv

__all__ = [
    "BLOCK_HIGH",
    "CHOICES",
    "CLOSING_RISE",
    "CLOSING_STEPS",
    "FINGER_OPEN",
    "GRASP_DISTANCE",
    "LIFTING_RISE",
    "LIFTING_STEPS",
    "RENDER_HEIGHT",
    "RENDER_WIDTH",
    "SINK",
    "WRIST_HIGH",
    "KukaGymEnv",
    "largeValObservation",
]

largeValObservation = 100
FINGER_OPEN = 0.3
CLOSING_STEPS, LIFTING_STEPS = 100, 1000
# Heights at which lifting ends [m].
BLOCK_HIGH, WRIST_HIGH = 0.23, 0.5
# Distance from the tray at which the gripper grasps [m].
GRASP_DISTANCE = 0.005
# Vertical motion of the gripper per step [m].
SINK = -0.002
# Rise of the wrist per step, while the fingers close and afterwards [m].
CLOSING_RISE, LIFTING_RISE = 0.0001, 0.001
# Discrete actions: motion along x, along y, and rotation.
CHOICES = ((0, 0, 0), (-1, 0, 0), (1, 0, 0), (0, -1, 0), (0, 1, 0), (0, 0, -1), (0, 0, 1))


class KukaGymEnv(UrdfEnv):
    """The gripper sinks by 2 mm per step; at the tray it closes and lifts, which ends the episode.

    Observation: position, roll, pitch and yaw of the gripper; x, y and yaw of the block in the gripper's
    frame. Action: motion along x and y and rotation, from -1 to 1, or one of 7 choices. Reward: -10 times the
    distance of block and wrist, minus a cost of turning, plus 10000 for a lifted block.

    Attributes:
        blockUid: Id of the block.
    """

    _timeStep = 1.0 / 240.0
    _camera = (1.3, 180.0, -40.0)
    _step_size = 0.005
    _turn_size = 0.05
    _turn_cost = 10.0
    _lifted_height = 0.2
    _success = 10000.0
    # Initial pose of the block: bounds of x, y [m] and yaw [rad]; height [m].
    _block_ranges: tuple[tuple[float, float], ...] = (
        (0.55, 0.67),
        (0.0, 0.2),
        (3.14 * 0.5, 3.14 * 0.5 + 3.1415925438),
    )
    _block_height = -0.15

    def __init__(
        self,
        urdfRoot: str | None = None,
        actionRepeat: int = 1,
        isEnableSelfCollision: bool = True,
        renders: bool = False,
        isDiscrete: bool = False,
        maxSteps: int = 1000,
        render_mode: str | None = None,
    ) -> None:
        """Makes the environment and its world; see `UrdfEnv`.

        Args:
            urdfRoot: Folder of the files.
            actionRepeat: Number of simulation steps per environment step.
            isEnableSelfCollision: No effect.
            renders: Whether to open a window.
            isDiscrete: Whether the action is one of 7 choices.
            maxSteps: Number of steps after which an episode ends.
            render_mode: `human`, `rgb_array` or none.
        """
        self._maxSteps = maxSteps
        super().__init__(urdfRoot, actionRepeat, isEnableSelfCollision, renders, isDiscrete, render_mode)
        self._p.resetDebugVisualizerCamera(1.3, 180, -41, [0.52, -0.2, -0.33])
        self._begin()

    def _actions(self) -> gymnasium.spaces.Space[Any]:
        if self._isDiscrete:
            return gymnasium.spaces.Discrete(len(CHOICES))
        return gymnasium.spaces.Box(-1.0, 1.0, (3,), np.float32)

    def _observations(self) -> gymnasium.spaces.Box:
        return gymnasium.spaces.Box(-100.0, 100.0, (9,), np.float32)

    def _begin(self) -> None:
        """Builds the world, with the block at a random place on the tray."""
        self.terminated = False
        self._envStepCounter = 0
        self._lay_table()
        place = [self.np_random.uniform(low, high) for low, high in self._block_ranges]
        self.blockUid = self._p.loadURDF(
            os.path.join(self._urdfRoot, "block.urdf"),
            [*place[:2], self._block_height],
            self._p.getQuaternionFromEuler([0, 0, place[2]]),
        )
        self._p.setGravity(0, 0, -10)
        self._kuka = Kuka(self._urdfRoot, self._timeStep, self._p)
        self._settle()

    def _settle(self) -> None:
        """Makes the simulation step that precedes an episode."""
        self._p.stepSimulation()

    def _lay_table(self) -> None:
        """Resets the world and loads floor and table."""
        self._p.resetSimulation()
        self._p.setPhysicsEngineParameter(numSolverIterations=150)
        self._p.setTimeStep(self._timeStep)
        self._p.loadURDF(os.path.join(self._urdfRoot, "plane.urdf"), [0, 0, -1])
        self._p.loadURDF(os.path.join(self._urdfRoot, "table/table.urdf"), [0.5, 0.0, -0.82])

    def getExtendedObservation(self) -> np.ndarray:
        """The present observation."""
        gripper = self._p.getLinkState(self._kuka.kukaUid, self._kuka.kukaGripperIndex)[:2]
        block = self._p.getBasePositionAndOrientation(self.blockUid)
        position, orientation = self._p.multiplyTransforms(*self._p.invertTransform(*gripper), *block)
        yaw = self._p.getEulerFromQuaternion(orientation)[2]
        return np.array([*self._kuka.getObservation(), *position[:2], yaw], np.float32)

    def step(self, action: Any) -> tuple[np.ndarray, float, bool, bool, dict[str, Any]]:
        """Applies an action for one step."""
        if self._isDiscrete:
            x, y, turn = CHOICES[int(action)]
        else:
            x, y, turn = (float(value) for value in action)
        size = self._step_size
        return self.step2([size * x, size * y, SINK, self._turn_size * turn, FINGER_OPEN])

    def step2(self, action: list[float]) -> tuple[np.ndarray, float, bool, bool, dict[str, Any]]:
        """Makes a step with an action of `Kuka.applyAction`."""
        for _ in range(self._actionRepeat):
            self._kuka.applyAction(action)
            self._p.stepSimulation()
            if self._termination():
                break
            self._envStepCounter += 1
        if self.render_mode == "human":
            time.sleep(self._timeStep)
        ended = self._termination()
        reward = self._reward() - self._turn_cost * abs(action[3])
        return self.getExtendedObservation(), reward, ended, False, {}

    def _looked_at(self) -> tuple[float, float, float]:
        return self._p.getBasePositionAndOrientation(self._kuka.kukaUid)[0]

    def _termination(self) -> bool:
        """Whether the episode is over; grasps when the gripper reaches the tray."""
        if self.terminated or self._envStepCounter > self._maxSteps:
            return True
        if not self._p.getClosestPoints(self._kuka.trayUid, self._kuka.kukaUid, GRASP_DISTANCE):
            return False
        self.terminated = True
        self._grasp()
        return True

    def _grasp(self) -> None:
        """Closes the fingers and lifts, until the block or the wrist is high enough."""
        for step in range(CLOSING_STEPS):
            finger = FINGER_OPEN * (1.0 - step / CLOSING_STEPS)
            self._kuka.applyAction([0, 0, CLOSING_RISE, 0, finger])
            self._p.stepSimulation()
        for _ in range(LIFTING_STEPS):
            self._kuka.applyAction([0, 0, LIFTING_RISE, 0, 0.0])
            self._p.stepSimulation()
            wrist = self._p.getLinkState(self._kuka.kukaUid, self._kuka.kukaEndEffectorIndex)[0]
            if self._block_position()[2] > BLOCK_HIGH or wrist[2] > WRIST_HIGH:
                return

    def _block_position(self) -> tuple[float, float, float]:
        return self._p.getBasePositionAndOrientation(self.blockUid)[0]

    def _reward(self) -> float:
        points = self._p.getClosestPoints(
            self.blockUid, self._kuka.kukaUid, 1000, -1, self._kuka.kukaEndEffectorIndex
        )
        reward = -10.0 * points[0][8] if points else -1000.0
        if self._block_position()[2] > self._lifted_height:
            reward += self._success
        return reward
