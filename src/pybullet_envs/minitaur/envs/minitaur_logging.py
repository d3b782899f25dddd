"""Logs of episodes, a file for each; see `minitaur_logging_pb2` for their format."""

from __future__ import annotations

import logging
import os
from datetime import datetime
from typing import Any

from pybullet_envs.minitaur.envs.minitaur_logging_pb2 import (
    MinitaurEpisode,
    MinitaurMotorState,
    MinitaurStateAction,
    Timestamp,
    Vector3d,
)


def preallocate_episode_proto(episode_proto: MinitaurEpisode, max_num_steps: int) -> None:
    """Makes room for so many steps at the end of an episode."""
    episode_proto.state_action.extend(MinitaurEpisode.of_steps(max_num_steps).state_action)


def update_episode_proto(episode_proto: MinitaurEpisode, minitaur: Any, action: Any, step: int) -> None:
    """Notes a step of an episode.

    Args:
        episode_proto: The episode; a step that it has no room for is left out, with a warning.
        minitaur: The robot.
        action: What its motors were commanded, (8,).
        step: The number of the step, from 0.
    """
    room = len(episode_proto.state_action)
    if step >= room:
        logging.warning(
            "%dth step is not recorded in the logging since only %d steps were pre-allocated.", step, room
        )
        return
    seconds = minitaur.GetTimeSinceReset()
    motors = zip(
        minitaur.GetMotorAngles(),
        minitaur.GetMotorVelocities(),
        minitaur.GetMotorTorques(),
        action,
        strict=True,
    )
    episode_proto.state_action[step] = MinitaurStateAction(
        time=Timestamp(int(seconds), int(seconds % 1 * 1e9)),
        base_position=Vector3d(*minitaur.GetBasePosition()),
        base_orientation=Vector3d(*minitaur.GetBaseRollPitchYaw()),
        base_angular_vel=Vector3d(*minitaur.GetBaseRollPitchYawRate()),
        motor_states=[MinitaurMotorState(*map(float, motor)) for motor in motors],
        info_valid=minitaur.IsObservationValid(),
    )


class MinitaurLogging:
    """A folder of logs."""

    def __init__(self, log_path: str | None = None) -> None:
        """Takes the folder, which is made when it is needed; without one nothing is written."""
        self._log_path = log_path

    def save_episode(self, episode_proto: MinitaurEpisode) -> str | None:
        """Writes an episode; tells the file, whose name has the time, or the folder if there is nothing."""
        if not self._log_path or not episode_proto.state_action:
            return self._log_path
        os.makedirs(self._log_path, exist_ok=True)
        file = os.path.join(self._log_path, f"minitaur_log_{datetime.now():%Y-%m-%d-%H%M%S}")
        with open(file, "wb") as log:
            log.write(episode_proto.SerializeToString())
        return file

    def restore_episode(self, log_path: str) -> MinitaurEpisode:
        """Reads an episode from a file.

        Raises:
            ValueError: It is no log.
        """
        episode = MinitaurEpisode()
        with open(log_path, "rb") as log:
            episode.ParseFromString(log.read())
        return episode
