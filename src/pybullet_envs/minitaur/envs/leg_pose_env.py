"""Base classes of environments in which actions are added to poses of the legs."""

from __future__ import annotations

from math import pi
from typing import Any

import numpy as np

from pybullet_envs.minitaur.envs.minitaur_gym_env import NUM_MOTORS, MinitaurGymEnv

NUM_LEGS = 4
# Signs of the motor angles for a swing: those of left and right legs are opposite.
_SWING = np.array((-1.0, 1.0, -1.0, 1.0, 1.0, -1.0, 1.0, -1.0))
_MAX_LEANING = 0.3


def motor_angles_of(pose: Any) -> np.ndarray:
    """Motor angles [rad], (8,), of a pose: swings of the legs, then extensions of the legs [rad], (8,)."""
    swing, extension = np.reshape(pose, (2, NUM_LEGS)).repeat(2, axis=1)
    return extension + _SWING * swing


def pose_of(motor_angles: Any) -> np.ndarray:
    """Pose of the legs [rad], (8,), at given motor angles; the inverse of `motor_angles_of`."""
    angles = np.asarray(motor_angles)
    swing, extension = (_SWING * angles).reshape(NUM_LEGS, 2), angles.reshape(NUM_LEGS, 2)
    return np.concatenate((swing.mean(axis=1), extension.mean(axis=1)))


class LegPoseEnv(MinitaurGymEnv):
    """A Minitaur whose legs follow a signal, to which actions are added.

    Observation: roll and pitch [rad]; then, depending on the arguments, their rates [rad/s], the motor angles
    [rad] of the signal alone, and the observed motor angles [rad].
    """

    _reset_duration = 0.5
    _camera = (1.0, 30.0, -30.0)

    def __init__(
        self,
        actions: int,
        bound: float,
        init_swing: float,
        init_extension: float,
        tells_rates: bool = True,
        tells_signal: bool = False,
        tells_angles: bool = False,
        **keywords: Any,
    ) -> None:
        """Makes the environment.

        Args:
            actions: Size of an action.
            bound: Largest magnitude of its numbers [rad].
            init_swing: Swing of each leg at the start of an episode [rad].
            init_extension: Extension of each leg at the start of an episode [rad].
            tells_rates: Whether the rates are observed.
            tells_signal: Whether the motor angles of the signal are observed.
            tells_angles: Whether the motor angles are observed.
            **keywords: Arguments of `MinitaurGymEnv`.
        """
        self._init_pose = np.repeat((init_swing, init_extension), NUM_LEGS)
        self._offset = np.zeros(NUM_MOTORS)
        self._tells_rates = tells_rates
        self._tells_signal = tells_signal
        self._tells_angles = tells_angles
        super().__init__(motor_overheat_protection=True, **keywords)
        self._set_spaces(actions, bound, self._get_observation_upper_bound())

    def set_swing_offset(self, value: Any) -> None:
        """Sets the offset of each leg's swing [rad], (4,)."""
        self._offset[:NUM_LEGS] = value

    def set_extension_offset(self, value: Any) -> None:
        """Sets the offset of each leg's extension [rad], (4,)."""
        self._offset[NUM_LEGS:] = value

    def _initial_motor_angles(self) -> np.ndarray:
        return motor_angles_of(self._init_pose)

    def _signal(self, t: float) -> np.ndarray:
        """The signal: pose of the legs [rad], (8,), at a time [s]."""
        return self._init_pose

    def _transform_action_to_motor_command(self, action: np.ndarray) -> np.ndarray:
        pose = self._signal(self.minitaur.GetTimeSinceReset())
        return motor_angles_of(pose + self._offset + action)

    def is_fallen(self) -> bool:
        """Whether roll or pitch of the base is larger than 0.3 rad."""
        return bool((np.abs(self.minitaur.GetTrueBaseRollPitchYaw()[:2]) > _MAX_LEANING).any())

    def _get_observation(self) -> np.ndarray:
        robot = self.minitaur
        self._observation = self._told(robot.GetBaseRollPitchYaw(), robot.GetBaseRollPitchYawRate())
        return self._observation

    def _get_true_observation(self) -> np.ndarray:
        robot = self.minitaur
        return self._told(robot.GetTrueBaseRollPitchYaw(), robot.GetTrueBaseRollPitchYawRate())

    def _told(self, angles: np.ndarray, rates: np.ndarray) -> np.ndarray:
        """An observation with given roll, pitch and yaw of the base [rad], and their rates [rad/s]."""
        parts = [angles[:2]]
        if self._tells_rates:
            parts.append(rates[:2])
        if self._tells_signal:
            parts.append(self._transform_action_to_motor_command(np.zeros(NUM_MOTORS)))
        if self._tells_angles:
            parts.append(self.minitaur.GetMotorAngles())
        return np.concatenate(parts)

    def _get_observation_upper_bound(self) -> np.ndarray:
        motors = NUM_MOTORS * (self._tells_signal + self._tells_angles)
        most_rate = 2 * pi / self._time_step
        return np.repeat((2 * pi, most_rate, 2 * pi), (2, 2 * self._tells_rates, motors))


class BentLegsEnv(LegPoseEnv):
    """Legs whose offsets also apply to the initial pose, and a desired pitch of the base."""

    def __init__(self, **keywords: Any) -> None:
        """Makes the environment; see `LegPoseEnv`."""
        self.desired_pitch = 0.0
        super().__init__(**keywords)

    def set_desired_pitch(self, value: float) -> None:
        """Sets the desired pitch of the base until the episode ends [rad]."""
        self.desired_pitch = value

    def _begin_episode(self) -> None:
        super()._begin_episode()
        self.desired_pitch = 0.0

    def _initial_motor_angles(self) -> np.ndarray:
        return motor_angles_of(self._init_pose + self._offset)
