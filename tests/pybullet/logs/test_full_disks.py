"""Logs that cannot be written end with a warning; steps and connections go on."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

import pybullet as p
import pybullet_data

FULL = "/dev/full"
KINDS = (p.STATE_LOGGING_GENERIC_ROBOT, p.STATE_LOGGING_CONTACT_POINTS)

pytestmark = pytest.mark.skipif(not Path(FULL).exists(), reason="there is no device that is full")


@pytest.fixture
def client() -> Iterator[int]:
    number = p.connect(p.DIRECT)
    p.setAdditionalSearchPath(pybullet_data.getDataPath())
    p.loadURDF("cube_small.urdf")
    yield number
    if p.isConnected(number):
        p.disconnect(number)


@pytest.mark.parametrize("kind", KINDS)
def test_an_incomplete_log_says_so_when_it_is_stopped(client: int, kind: int) -> None:
    log = p.startStateLogging(kind, FULL)
    for _ in range(200):
        p.stepSimulation()
    with pytest.raises(p.error, match=r"stopStateLogging failed\. /dev/full is incomplete"):
        p.stopStateLogging(log)
    p.stopStateLogging(log)
    p.stepSimulation()


def test_timings_on_a_full_disk(client: int, tmp_path: Path) -> None:
    (tmp_path / "timings_0.json").symlink_to(FULL)
    log = p.startStateLogging(p.STATE_LOGGING_PROFILE_TIMINGS, str(tmp_path / "timings"))
    p.stepSimulation()
    with pytest.raises(p.error, match="is incomplete"):
        p.stopStateLogging(log)


@pytest.mark.parametrize("kind", KINDS)
def test_a_connection_ends_all_the_same(client: int, kind: int, caplog: pytest.LogCaptureFixture) -> None:
    p.startStateLogging(kind, FULL)
    p.stepSimulation()
    p.disconnect(client)
    assert not p.isConnected(client)
    assert "is incomplete" in caplog.text


@pytest.mark.skipif(sys.platform == "win32", reason="Windows has no such devices")
@pytest.mark.parametrize("device", ["/dev/zero", "/dev/full"])
def test_a_device_is_no_log_of_commands(client: int, device: str) -> None:
    with pytest.raises(p.error, match="not a regular file"):
        p.startStateLogging(p.STATE_REPLAY_ALL_COMMANDS, device)
