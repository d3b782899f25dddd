"""Logs of the Minitaur are Protocol Buffers messages, as PyBullet writes them."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

pytest.importorskip("google.protobuf")
from google.protobuf.message import DecodeError

from pybullet_envs.minitaur.envs import MinitaurReactiveEnv
from pybullet_envs.minitaur.envs.minitaur_logging import MinitaurLogging, preallocate_episode_proto
from pybullet_envs.minitaur.envs.minitaur_logging_pb2 import (
    MinitaurEpisode,
    MinitaurMotorState,
    Timestamp,
    Vector3d,
)

# Two steps, the second of them empty, written with PyBullet's own module and protobuf 3.20.
RECORDED = bytes.fromhex(
    "0a590a0908ac021080cab5ee01121209000000000000f83f1900000000000000c01a0911000000000000d03f220919000000"
    "00000008402a0909000000000000e03f2a002a002a002a002a002a002a0921000000000000f0bf30010a180a0012001a0022"
    "002a002a002a002a002a002a002a002a00"
)


def test_bytes_are_those_of_pybullet() -> None:
    episode = MinitaurEpisode()
    preallocate_episode_proto(episode, 2)
    step = episode.state_action[0]
    step.info_valid = True
    step.time.CopyFrom(Timestamp(seconds=300, nanos=500000000))
    step.base_position.CopyFrom(Vector3d(x=1.5, z=-2.0))
    step.base_orientation.y = 0.25
    step.base_angular_vel.z = 3.0
    step.motor_states[0].angle = 0.5
    step.motor_states[7].CopyFrom(MinitaurMotorState(action=-1.0))
    assert episode.SerializeToString() == RECORDED
    assert MinitaurEpisode.FromString(RECORDED) == episode


def test_what_is_no_log_is_refused(tmp_path: Path) -> None:
    file = tmp_path / "log"
    file.write_bytes(RECORDED[:-5])
    with pytest.raises(DecodeError):
        MinitaurLogging().restore_episode(str(file))


def test_an_environment_logs_its_episodes(tmp_path: Path) -> None:
    folder = tmp_path / "logs"
    env = MinitaurReactiveEnv(log_path=str(folder), num_steps_to_log=4)
    env.reset(seed=1)
    for _ in range(5):
        env.step(np.zeros(8))
    position = env.minitaur.GetBasePosition()
    env.close()
    (file,) = folder.iterdir()
    episode = MinitaurLogging(str(folder)).restore_episode(str(file))
    assert [step.info_valid for step in episode.state_action] == [True] * 4
    assert [step.time.nanos for step in episode.state_action] == pytest.approx([6e6, 12e6, 18e6, 24e6], abs=2)
    last = episode.state_action[-1]
    assert (last.base_position.x, last.base_position.z) == pytest.approx((position[0], position[2]), abs=0.01)
    assert [motor.action for motor in last.motor_states] == pytest.approx([2.0] * 8)


def test_nothing_is_written_without_a_folder() -> None:
    episode = MinitaurEpisode()
    preallocate_episode_proto(episode, 3)
    assert len(episode.state_action) == 3
    assert MinitaurLogging().save_episode(episode) is None


def test_environments_without_logs_need_no_protobuf() -> None:
    script = """
import sys
sys.modules["google.protobuf"] = None
import numpy as np
from pybullet_envs.minitaur.envs import MinitaurReactiveEnv
env = MinitaurReactiveEnv()
env.reset(seed=1)
env.step(np.zeros(8))
env.close()
"""
    subprocess.run([sys.executable, "-c", script], check=True)
