"""Logs of episodes, a file for each; see `minitaur_logging_pb2` for their format."""

from __future__ import annotations

import logging
import os
from datetime import datetime
from typing import Any

from carom.writing import write_whole
from pybullet_envs.minitaur.envs.minitaur_logging_pb2 import MinitaurEpisode

NUM_MOTORS = 8


def preallocate_episode_proto(episode_proto: Any, max_num_steps: int) -> None:
    """Appends `max_num_steps` empty steps to an episode, a `MinitaurEpisode`."""
    for _ in range(max_num_steps):
        step = episode_proto.state_action.add()
        # PyBullet's logs contain these messages, empty, also in steps that are not recorded.
        for name in ("time", "base_position", "base_orientation", "base_angular_vel"):
            getattr(step, name).SetInParent()
        for _ in range(NUM_MOTORS):
            step.motor_states.add()


def update_episode_proto(episode_proto: Any, minitaur: Any, action: Any, step: int) -> None:
    """Records a step of an episode.

    Args:
        episode_proto: The episode; steps beyond those it has are not recorded, with a warning.
        minitaur: The robot.
        action: The commands of its motors, (8,).
        step: Index of the step, from 0.
    """
    room = len(episode_proto.state_action)
    if step >= room:
        logging.warning(
            "%dth step is not recorded in the logging since only %d steps were pre-allocated.", step, room
        )
        return
    log = episode_proto.state_action[step]
    seconds = minitaur.GetTimeSinceReset()
    log.info_valid = minitaur.IsObservationValid()
    log.time.seconds, log.time.nanos = int(seconds), int(seconds % 1 * 1e9)
    for vector, numbers in (
        (log.base_position, minitaur.GetBasePosition()),
        (log.base_orientation, minitaur.GetBaseRollPitchYaw()),
        (log.base_angular_vel, minitaur.GetBaseRollPitchYawRate()),
    ):
        vector.x, vector.y, vector.z = map(float, numbers)
    motors = zip(
        minitaur.GetMotorAngles(),
        minitaur.GetMotorVelocities(),
        minitaur.GetMotorTorques(),
        action,
        strict=True,
    )
    for state, numbers in zip(log.motor_states, motors, strict=True):
        state.angle, state.velocity, state.torque, state.action = map(float, numbers)


class MinitaurLogging:
    """A folder of logs."""

    def __init__(self, log_path: str | None = None) -> None:
        """Sets the folder, which is created when needed; without one nothing is written."""
        self._log_path = log_path

    def save_episode(self, episode_proto: Any) -> str | None:
        """Writes an episode; returns the file, named by the time, or the folder if nothing is written."""
        if not self._log_path or not episode_proto.state_action:
            return self._log_path
        os.makedirs(self._log_path, exist_ok=True)
        file = os.path.join(self._log_path, f"minitaur_log_{datetime.now():%Y-%m-%d-%H%M%S}")
        write_whole(file, episode_proto.SerializeToString())
        return file

    def restore_episode(self, log_path: str) -> Any:
        """Reads a `MinitaurEpisode` from a file.

        Raises:
            google.protobuf.message.DecodeError: The file is not a log.
        """
        with open(log_path, "rb") as log:
            return MinitaurEpisode.FromString(log.read())
