"""An environment with a Minitaur that carries a duck on its back."""

from __future__ import annotations

import os

from pybullet_envs.bullet.minitaur_gym_env import (
    ACTION_EPS,
    BASE_ORIENTATION_OBSERVATION_INDEX,
    MOTOR_ANGLE_OBSERVATION_INDEX,
    MOTOR_TORQUE_OBSERVATION_INDEX,
    MOTOR_VELOCITY_OBSERVATION_INDEX,
    NUM_MOTORS,
    NUM_SUBSTEPS,
    OBSERVATION_EPS,
    RENDER_HEIGHT,
    RENDER_WIDTH,
    MinitaurBulletEnv,
)

__all__ = [
    "ACTION_EPS",
    "BASE_ORIENTATION_OBSERVATION_INDEX",
    "MOTOR_ANGLE_OBSERVATION_INDEX",
    "MOTOR_TORQUE_OBSERVATION_INDEX",
    "MOTOR_VELOCITY_OBSERVATION_INDEX",
    "NUM_MOTORS",
    "NUM_SUBSTEPS",
    "OBSERVATION_EPS",
    "RENDER_HEIGHT",
    "RENDER_WIDTH",
    "MinitaurBulletDuckEnv",
    "duckStartOrn",
    "duckStartPos",
]

duckStartPos = (0.0, 0.0, 0.25)
duckStartOrn = (0.5, 0.5, 0.5, 0.5)


class MinitaurBulletDuckEnv(MinitaurBulletEnv):
    """Like `MinitaurBulletEnv`, but an episode also ends when the duck touches the ground."""

    def _load_things(self) -> None:
        file = os.path.join(self._urdf_root, "duck_vhacd.urdf")
        self._duckId = self._p.loadURDF(file, duckStartPos, duckStartOrn)

    def lost_duck(self) -> bool:
        """Whether the duck touches the ground."""
        return len(self._p.getContactPoints(self._duckId, self._ground_id)) > 0

    def _termination(self) -> bool:
        return self.lost_duck() or super()._termination()
