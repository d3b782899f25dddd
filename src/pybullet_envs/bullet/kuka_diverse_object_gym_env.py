"""An environment with a KUKA that grasps random objects in a tray, observed by a camera."""

from __future__ import annotations

import glob
import os
import time
from typing import Any

import numpy as np

from pybullet_envs._gymnasium import gymnasium
from pybullet_envs.bullet.kuka import Kuka
from pybullet_envs.bullet.kukaGymEnv import KukaGymEnv

_FINGER_OPEN = 0.3
_GRASP_HEIGHT = 0.1
_GRASP_STEPS, _SETTLING_STEPS = 500, 500
_LIFTED_HEIGHT = 0.2
_TURN = 0.25


class KukaDiverseObjectEnv(KukaGymEnv):
    """Up to eight moves, then one attempt to grasp one of several random objects of `pybullet_data`.

    Observation: an image (height, width, 3). Action: motion along x, y (and z with `removeHeightHack`;
    otherwise the gripper sinks by itself) and rotation, from -1 to 1, or one of 7 or 9 choices. Reward: 1 if
    an object is lifted in the end. The info dictionary of a step repeats this as `grasp_success`.
    """

    def __init__(
        self,
        urdfRoot: str | None = None,
        actionRepeat: int = 80,
        isEnableSelfCollision: bool = True,
        renders: bool = False,
        isDiscrete: bool = False,
        maxSteps: int = 8,
        dv: float = 0.06,
        removeHeightHack: bool = False,
        blockRandom: float = 0.3,
        cameraRandom: float = 0,
        width: int = 48,
        height: int = 48,
        numObjects: int = 5,
        isTest: bool = False,
        render_mode: str | None = None,
    ) -> None:
        """Makes the environment and its world.

        Args:
            urdfRoot: Folder of the files; by default that of `pybullet_data`.
            actionRepeat: Number of simulation steps per environment step.
            isEnableSelfCollision: No effect.
            renders: Whether to open a window.
            isDiscrete: Whether the action is one of several choices.
            maxSteps: Number of steps after which an episode ends.
            dv: Motion per step along each axis, for an action of 1 [m].
            removeHeightHack: Whether actions contain the vertical motion of the gripper.
            blockRandom: Spread of the objects, 0 to 1.
            cameraRandom: Variation of the camera from episode to episode, 0 to 1.
            width: Width of the image [pixels].
            height: Height of the image [pixels].
            numObjects: Number of objects.
            isTest: Whether to use the objects reserved for tests.
            render_mode: `human`, `rgb_array` or none.
        """
        self._dv = dv
        self._removeHeightHack = removeHeightHack
        self._blockRandom = blockRandom
        self._cameraRandom = cameraRandom
        self._width, self._height = width, height
        self._numObjects = numObjects
        self._isTest = isTest
        super().__init__(
            urdfRoot, actionRepeat, isEnableSelfCollision, renders, isDiscrete, maxSteps, render_mode
        )

    def _actions(self) -> gymnasium.spaces.Space[Any]:
        axes = 4 if self._removeHeightHack else 3
        if self._isDiscrete:
            return gymnasium.spaces.Discrete(2 * axes + 1)
        return gymnasium.spaces.Box(-1.0, 1.0, (axes,), np.float32)

    def _observations(self) -> gymnasium.spaces.Box:
        return gymnasium.spaces.Box(0, 255, (self._height, self._width, 3), np.uint8)

    def _begin(self) -> None:
        self.terminated = False
        self._attempted_grasp = False
        self._env_step = self._envStepCounter = 0
        self._graspSuccess = 0
        self._aim_camera()
        self._lay_table()
        self._p.setGravity(0, 0, -10)
        self._kuka = Kuka(self._urdfRoot, self._timeStep, self._p)
        self._p.stepSimulation()
        self._objectUids = [self._drop(file) for file in self._choose_objects()]

    def _aim_camera(self) -> None:
        spread = self._cameraRandom
        pitch = -56 + spread * self.np_random.uniform(-3, 3)
        yaw = 245 + spread * self.np_random.uniform(-3, 3)
        field_of_view = 20.0 + spread * self.np_random.uniform(-2, 2)
        self._view_matrix = self._p.computeViewMatrixFromYawPitchRoll(
            [0.23, 0.2, 0.54], 1.0, yaw, pitch, 0, 2
        )
        self._proj_matrix = self._p.computeProjectionMatrixFOV(
            field_of_view, self._width / self._height, 0.01, 10
        )

    def _choose_objects(self) -> list[str]:
        """Files of random objects; one in ten of all objects is reserved for tests."""
        pattern = "random_urdfs/*0/*.urdf" if self._isTest else "random_urdfs/*[1-9]/*.urdf"
        files = sorted(glob.glob(os.path.join(self._urdfRoot, pattern)))
        return [files[i] for i in self.np_random.integers(len(files), size=self._numObjects)]

    def _drop(self, file: str) -> int:
        """Loads an object above the tray and lets it fall and settle; returns its id."""
        spread = self._blockRandom
        place = [
            0.4 + spread * self.np_random.uniform(),
            spread * (self.np_random.uniform() - 0.5),
            0.15,
        ]
        yaw = np.pi / 2 + spread * np.pi * self.np_random.uniform()
        body = self._p.loadURDF(file, place, self._p.getQuaternionFromEuler([0, 0, yaw]))
        for _ in range(_SETTLING_STEPS):
            self._p.stepSimulation()
        return body

    def getExtendedObservation(self) -> np.ndarray:
        """The present image of the camera."""
        picture: Any = self._p.getCameraImage(
            self._width, self._height, viewMatrix=self._view_matrix, projectionMatrix=self._proj_matrix
        )[2]
        return np.reshape(picture, (self._height, self._width, 4))[:, :, :3].astype(np.uint8)

    def step(self, action: Any) -> tuple[np.ndarray, float, bool, bool, dict[str, Any]]:
        """Applies an action for one step; grasps if the gripper is low enough."""
        *moves, turn = self._chosen(int(action)) if self._isDiscrete else [float(value) for value in action]
        sink = moves.pop() if self._removeHeightHack else -1.0
        x, y = (self._dv * move for move in moves)
        self._env_step += 1
        self._kuka.applyAction([x, y, self._dv * sink, _TURN * turn, _FINGER_OPEN])
        for _ in range(self._actionRepeat):
            self._p.stepSimulation()
            if self.render_mode == "human":
                time.sleep(self._timeStep)
            if self._termination():
                break
        wrist = self._p.getLinkState(self._kuka.kukaUid, self._kuka.kukaEndEffectorIndex)[0]
        if wrist[2] <= _GRASP_HEIGHT:
            self._grasp()
            self._attempted_grasp = True
        reward = self._reward()
        found = {"grasp_success": self._graspSuccess}
        return self.getExtendedObservation(), reward, self._termination(), False, found

    def _chosen(self, number: int) -> list[float]:
        """The action of a choice: no motion, or motion in one direction of one axis."""
        moves = [0.0] * (4 if self._removeHeightHack else 3)
        if number:
            moves[(number - 1) // 2] = 1.0 if number % 2 == 0 else -1.0
        return moves

    def _grasp(self) -> None:
        finger = _FINGER_OPEN
        for lift in (0.0, 0.001):
            for _ in range(_GRASP_STEPS):
                self._kuka.applyAction([0, 0, lift, 0, finger])
                self._p.stepSimulation()
                finger = max(finger - _FINGER_OPEN / 100.0, 0.0)

    def _termination(self) -> bool:
        return self._attempted_grasp or self._env_step >= self._maxSteps

    def _reward(self) -> float:
        heights = [self._p.getBasePositionAndOrientation(body)[0][2] for body in self._objectUids]
        self._graspSuccess = int(max(heights, default=0.0) > _LIFTED_HEIGHT)
        return float(self._graspSuccess)
