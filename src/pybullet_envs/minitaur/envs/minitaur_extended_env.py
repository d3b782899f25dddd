"""An environment with a Minitaur whose observations contain earlier actions and observations."""

from __future__ import annotations

from typing import Any

import numpy as np

from pybullet_envs._gymnasium import gymnasium
from pybullet_envs.minitaur.envs.leg_pose_env import NUM_LEGS, pose_of
from pybullet_envs.minitaur.envs.minitaur_gym_env import NUM_MOTORS
from pybullet_envs.minitaur.envs.minitaur_reactive_env import MinitaurReactiveEnv
from pybullet_envs.minitaur_env_bases import Step

_MAX_SWING = 0.8
_MAX_STEPS = 500
_MAX_VELOCITY = 0.5
_JERKINESS = 0.1


class MinitaurExtendedEnv(MinitaurReactiveEnv):
    """Like `MinitaurReactiveEnv`, but observations also contain the latest actions and observations.

    Observation: that of `MinitaurReactiveEnv`; then, depending on the arguments, earlier observations and
    earlier actions, the latest first, first and second differences of the motor angles [rad], position of the
    base [m], and pose of the legs [rad]. Action: from -1 to 1. Reward: the velocity along x, up to 0.5 m/s,
    minus a tenth of the mean magnitude of the second differences of the actions. An episode ends after 500
    steps, or when a front leg swings by more than 0.8 rad.
    """

    metadata = {"render_modes": ["human", "rgb_array"], "render_fps": 50}  # noqa: RUF012  # as Gymnasium has it

    def __init__(
        self,
        history_length: int = 1,
        history_include_actions: bool = True,
        history_include_states: bool = False,
        include_state_difference: bool = False,
        include_second_state_difference: bool = False,
        include_base_position: bool = False,
        include_leg_model: bool = False,
        never_terminate: bool = False,
        action_scale: float = 0.5,
        **kwargs: Any,
    ) -> None:
        """Makes the environment.

        Args:
            history_length: Number of earlier steps in observations.
            history_include_actions: Whether the actions of these steps are observed.
            history_include_states: Whether the observations of these steps are observed.
            include_state_difference: Whether differences of the motor angles are observed.
            include_second_state_difference: Whether second differences of the motor angles are observed.
            include_base_position: Whether the position of the base is observed.
            include_leg_model: Whether the pose of the legs is observed.
            never_terminate: Whether episodes never end by themselves.
            action_scale: Motor angle for an action of 1 [rad].
            **kwargs: Arguments of `MinitaurReactiveEnv`; motor angles are always observed.
        """
        self._keywords = {
            "history_length": history_length,
            "history_include_actions": history_include_actions,
            "history_include_states": history_include_states,
            "include_state_difference": include_state_difference,
            "include_second_state_difference": include_second_state_difference,
            "include_base_position": include_base_position,
            "include_leg_model": include_leg_model,
            "never_terminate": never_terminate,
            "action_scale": action_scale,
            **kwargs,
        }
        self._history_length = history_length
        self._remembers_actions = history_include_actions
        self._remembers_states = history_include_states
        self._tells_change = include_state_difference
        self._tells_second_change = include_second_state_difference
        self._tells_position = include_base_position
        self._tells_pose = include_leg_model
        self._never_terminate = never_terminate
        self._action_scale = action_scale
        self._past_states: list[np.ndarray] = []
        self._past_actions: list[np.ndarray] = []
        super().__init__(**{**kwargs, "use_angle_in_observation": True})
        own = 4 + NUM_MOTORS
        remembered = own * history_include_states + NUM_MOTORS * history_include_actions
        motors = include_state_difference + include_second_state_difference + include_leg_model
        size = own + history_length * remembered + NUM_MOTORS * motors + 3 * include_base_position
        self.action_space = gymnasium.spaces.Box(-1.0, 1.0, (NUM_MOTORS,), np.float32)
        self.observation_space = gymnasium.spaces.Box(-np.inf, np.inf, (size,), np.float32)

    def __getstate__(self) -> dict[str, Any]:
        return self._keywords

    def __setstate__(self, state: dict[str, Any]) -> None:
        self.__init__(**state)

    def _begin_episode(self) -> None:
        super()._begin_episode()
        self._past_states.clear()
        self._past_actions.clear()

    def step(self, action: Any) -> Step:
        """Applies an action for one step.

        Returns:
            The five values of `step`; the info dictionary has the reward as `base_reward`.

        Raises:
            ValueError: The action is not eight finite numbers.
        """
        observation, reward, ended, cut, found = super().step(action)
        return observation, reward, ended, cut, found | {"base_reward": reward}

    def _transform_action_to_motor_command(self, action: np.ndarray) -> np.ndarray:
        scaled = action * self._action_scale
        self._past_actions.append(scaled)
        return super()._transform_action_to_motor_command(scaled)

    def _get_observation(self) -> np.ndarray:
        self._past_states.append(super()._get_observation())
        steps = range(1, self._history_length + 1)
        parts = [self._past_states[-1]]
        if self._remembers_states:
            parts += [_back(self._past_states, step) for step in steps]
        if self._remembers_actions:
            # Before the first action, the legs stand.
            actions = self._past_actions or [np.zeros(NUM_MOTORS)]
            parts += [_back(actions, step - 1) for step in steps]
        now, before, earlier = (_back(self._past_states, step)[-NUM_MOTORS:] for step in range(3))
        if self._tells_change:
            parts.append(now - before)
        if self._tells_second_change:
            parts.append(now - 2 * before + earlier)
        if self._tells_position:
            parts.append(np.array(self.minitaur.GetBasePosition()))
        if self._tells_pose:
            parts.append(pose_of(self.minitaur.GetMotorAngles()))
        return np.concatenate(parts)

    def _termination(self) -> bool:
        if self._never_terminate:
            return False
        swing = pose_of(self.minitaur.GetMotorAngles())[: NUM_LEGS : NUM_LEGS // 2]
        return len(self._past_actions) >= _MAX_STEPS or bool((swing > _MAX_SWING).any())

    def _reward(self) -> float:
        way = self.minitaur.GetBasePosition()[0] - self._last_base_position[0]
        velocity = np.clip(way / self.control_time_step, -_MAX_VELOCITY, _MAX_VELOCITY)
        now, before, earlier = (_back(self._past_actions, step) for step in range(3))
        return float(velocity - _JERKINESS * np.abs(now - 2 * before + earlier).mean())

    def reward(self) -> float:
        """The reward of the last step."""
        return self._reward()

    @staticmethod
    def convert_to_leg_model(motor_angles: Any) -> np.ndarray:
        """Pose of the legs at given motor angles: swings, then extensions [rad], (8,)."""
        return pose_of(motor_angles)

    def terminate(self) -> None:
        """Closes the world, like `close`."""
        self.close()


def _back(past: list[np.ndarray], steps: int) -> np.ndarray:
    """The entry `steps` before the last one, or the first one if there are fewer."""
    return past[max(len(past) - 1 - steps, 0)]
